// Two baselines without a library, both with the classical Runge-Kutta method: one object per
// particle, as a student writes it, and a structure of arrays, as an experienced programmer writes
// it.
#include <cmath>

#include "plain_force.hpp"
#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

struct Vector {
  double x = 0.0, y = 0.0;
};
Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y};
}
Vector operator*(double s, const Vector& a) {
  return {s * a.x, s * a.y};
}
double dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y;
}

struct Particle {
  Vector position, velocity;
  double mass = 1.0;
};
struct Slope {
  Vector velocity, acceleration;
};

class ObjectPerParticle : public Peer {
 public:
  ObjectPerParticle(const Problem& problem, const Run& run)
      : problem_(problem), run_(run), particles_(problem.size()) {
    reset();
  }

  void reset() override {
    const std::size_t n = particles_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double* z = problem_.start.data() + i;
      particles_[i] = {{z[0], z[n]}, {z[2 * n], z[3 * n]}, problem_.masses[i]};
    }
  }

  void advance() override {
    for (std::int64_t n = 0; n < run_.steps; ++n) step(run_.time_step);
  }

  std::vector<double> state() const override {
    std::vector<double> z;
    for (const Particle& p : particles_) z.push_back(p.position.x);
    for (const Particle& p : particles_) z.push_back(p.position.y);
    for (const Particle& p : particles_) z.push_back(p.velocity.x);
    for (const Particle& p : particles_) z.push_back(p.velocity.y);
    return z;
  }

  std::int64_t forceEvaluations() const override { return evaluations_; }

 private:
  Vector springForce(const Particle& here, const Particle& there) const {
    const Vector d = there.position - here.position;
    const double length = std::sqrt(dot(d, d));
    const Vector r = 1.0 / length * d;
    const double rate = dot(there.velocity - here.velocity, r);
    return (problem_.stiffness * (length - problem_.rest_length) + problem_.damping * rate) * r;
  }

  std::vector<Slope> slopes(const std::vector<Particle>& particles) {
    ++evaluations_;
    std::vector<Slope> result(particles.size());
    for (std::size_t i = 1; i < particles.size(); ++i) {
      Vector force = springForce(particles[i], particles[i - 1]);
      if (i + 1 < particles.size()) force = force + springForce(particles[i], particles[i + 1]);
      result[i].velocity = particles[i].velocity;
      result[i].acceleration = 1.0 / particles[i].mass * force + Vector{0.0, -problem_.gravity};
    }
    return result;
  }

  static std::vector<Particle> moved(std::vector<Particle> particles, double h,
                                     const std::vector<Slope>& k) {
    for (std::size_t i = 0; i < particles.size(); ++i) {
      particles[i].position = particles[i].position + h * k[i].velocity;
      particles[i].velocity = particles[i].velocity + h * k[i].acceleration;
    }
    return particles;
  }

  void step(double h) {
    const std::vector<Slope> k1 = slopes(particles_);
    const std::vector<Slope> k2 = slopes(moved(particles_, h / 2, k1));
    const std::vector<Slope> k3 = slopes(moved(particles_, h / 2, k2));
    const std::vector<Slope> k4 = slopes(moved(particles_, h, k3));
    particles_ = moved(particles_, h / 6, k1);
    particles_ = moved(particles_, h / 3, k2);
    particles_ = moved(particles_, h / 3, k3);
    particles_ = moved(particles_, h / 6, k4);
  }

  const Problem& problem_;
  Run run_;
  std::vector<Particle> particles_;
  std::int64_t evaluations_ = 0;
};

/// Two passes per stage: spring forces, then accelerations and the sums that need them, so that no
/// slope is stored.
class StructureOfArrays : public Peer {
 public:
  StructureOfArrays(const Problem& problem, const Run& run)
      : run_(run),
        start_(problem.start),
        size_(problem.size()),
        force_(problem),
        state_(start_),
        stage_(start_),
        sum_(start_) {}

  void reset() override { state_ = start_; }

  void advance() override {
    for (std::int64_t n = 0; n < run_.steps; ++n) step(run_.time_step);
  }

  std::vector<double> state() const override { return state_; }
  std::int64_t forceEvaluations() const override { return force_.evaluations(); }

 private:
  /// sum = from + weight * F(at), to = state + reach * F(at).
  void stage(const double* at, const double* from, double weight, double* to, double reach) {
    const std::size_t n = size_;
    force_.springForces(at);
    const double* __restrict fx = force_.forceX();
    const double* __restrict fy = force_.forceY();
    const double* __restrict inverse_mass = force_.inverseMasses();
    const double gravity = force_.gravity();
    const double* state = state_.data();
    double* sum = sum_.data();
#pragma GCC ivdep
    for (std::size_t i = 1; i < n; ++i) {
      const double vx = at[2 * n + i];
      const double vy = at[3 * n + i];
      const double ax = (fx[i] - fx[i - 1]) * inverse_mass[i];
      const double ay = (fy[i] - fy[i - 1]) * inverse_mass[i] - gravity;
      sum[i] = from[i] + weight * vx;
      sum[n + i] = from[n + i] + weight * vy;
      sum[2 * n + i] = from[2 * n + i] + weight * ax;
      sum[3 * n + i] = from[3 * n + i] + weight * ay;
      to[i] = state[i] + reach * vx;
      to[n + i] = state[n + i] + reach * vy;
      to[2 * n + i] = state[2 * n + i] + reach * ax;
      to[3 * n + i] = state[3 * n + i] + reach * ay;
    }
  }

  /// state = sum + weight * F(at).
  void lastStage(const double* at, double weight) {
    const std::size_t n = size_;
    force_.springForces(at);
    const double* __restrict fx = force_.forceX();
    const double* __restrict fy = force_.forceY();
    const double* __restrict inverse_mass = force_.inverseMasses();
    const double gravity = force_.gravity();
    const double* __restrict sum = sum_.data();
    double* __restrict state = state_.data();
#pragma GCC ivdep
    for (std::size_t i = 1; i < n; ++i) {
      state[i] = sum[i] + weight * at[2 * n + i];
      state[n + i] = sum[n + i] + weight * at[3 * n + i];
      state[2 * n + i] = sum[2 * n + i] + weight * ((fx[i] - fx[i - 1]) * inverse_mass[i]);
      state[3 * n + i] =
          sum[3 * n + i] + weight * ((fy[i] - fy[i - 1]) * inverse_mass[i] - gravity);
    }
  }

  void step(double h) {
    double* const state = state_.data();
    double* const sum = sum_.data();
    double* const at = stage_.data();
    stage(state, state, h / 6, at, h / 2);
    stage(at, sum, h / 3, at, h / 2);
    stage(at, sum, h / 3, at, h);
    lastStage(at, h / 6);
  }

  Run run_;
  const std::vector<double>& start_;
  std::size_t size_;
  PlainForce force_;
  std::vector<double> state_, stage_, sum_;
};

}  // namespace

std::vector<PeerRow> plainRows() {
  return {{"plain", "object per particle", Stepping::kFixed, true, makerOf<ObjectPerParticle>()},
          {"plain", "structure of arrays", Stepping::kFixed, true, makerOf<StructureOfArrays>()}};
}

}  // namespace spring_pendulum::benchmark
