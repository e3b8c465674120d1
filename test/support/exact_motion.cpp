#include "support/exact_motion.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace spring_pendulum::test {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Pair = Eigen::Matrix<Real, 2, 1>;

constexpr Real kVelocityWeight = 0.05L;  // s, converts a velocity error to a position error
constexpr double kWorkPerSecond = 2e7;   // particles x evaluations
constexpr double kFlopsPerSecond = 1e9;  // a factorisation counts as (unknowns)^3
constexpr double kPerturbation = 1e-9;   // m

/// Positions x_1, y_1, x_2, ... and velocities, of the moving particles only.
struct Motion {
  Vector p, v;
};

struct Spring {
  Real length;
  Pair direction;
  Pair velocity;  ///< of its far end relative to its near end
};

struct Model {
  explicit Model(const Chain& chain, const Pair& anchor)
      : size(chain.size() - 1),
        stiffness(chain.spring().stiffness),
        damping(chain.spring().damping),
        rest_length(chain.spring().rest_length),
        gravity(chain.gravity()),
        masses(chain.masses().tail(size).cast<Real>()),
        anchor_place(anchor) {}

  /// Spring i joins the moving particles i - 1 and i; spring 0 joins the anchor and particle 0.
  Spring spring(const Motion& z, Eigen::Index i) const {
    const Pair before = i == 0 ? anchor_place : Pair(z.p.segment<2>(2 * i - 2));
    const Pair separation = z.p.segment<2>(2 * i) - before;
    const Pair velocity =
        i == 0 ? Pair(z.v.segment<2>(0)) : Pair(z.v.segment<2>(2 * i) - z.v.segment<2>(2 * i - 2));
    const Real length = std::sqrt(separation.squaredNorm());
    return {length, length > 0 ? Pair(separation / length) : Pair(0, 0), velocity};
  }

  Real tension(const Spring& s) const {
    return stiffness * (s.length - rest_length) + damping * s.velocity.dot(s.direction);
  }

  void acceleration(const Motion& z, Vector& a) const {
    for (Eigen::Index i = 0; i < size; ++i) a.segment<2>(2 * i) << 0, -gravity;
    for (Eigen::Index i = 0; i < size; ++i) {
      const Spring s = spring(z, i);
      const Pair force = tension(s) * s.direction;
      a.segment<2>(2 * i) -= force / masses[i];
      if (i > 0) a.segment<2>(2 * i - 2) += force / masses[i - 1];
    }
  }

  Eigen::Index size;  ///< moving particles
  Real stiffness, damping, rest_length, gravity;
  Vector masses;
  Pair anchor_place;
};

Real difference(const Motion& a, const Motion& b) {
  const Real d = std::max((a.p - b.p).lpNorm<Eigen::Infinity>(),
                          kVelocityWeight * (a.v - b.v).lpNorm<Eigen::Infinity>());
  return a.p.allFinite() && a.v.allFinite() && b.p.allFinite() && b.v.allFinite() ? d : 1e30L;
}

class Extrapolation {
 public:
  static constexpr Real kTolerance = 1e-13L;  // the least that rounding errors allow
  static constexpr int kOrder = 19;           // order of the error estimate

  explicit Extrapolation(const Model& model) : model_(model), a_(2 * model.size) {}

  double secondsPerStep() const {
    return kColumns * (kColumns + 2) * static_cast<double>(model_.size) / kWorkPerSecond;
  }

  /// Advances z by h; returns the difference of the last two columns.
  Real step(Motion& z, Real h) {
    Motion before;
    for (int k = 0; k < kColumns; ++k) {
      table_[k] = midpointRule(z, h, 2 * (k + 1));
      if (k == kColumns - 1) before = table_[0];
      for (int j = k - 1; j >= 0; --j) {
        const Real ratio = Real(k + 1) / Real(j + 1);
        const Real factor = 1 / (ratio * ratio - 1);
        table_[j].p = table_[j + 1].p + (table_[j + 1].p - table_[j].p) * factor;
        table_[j].v = table_[j + 1].v + (table_[j + 1].v - table_[j].v) * factor;
      }
    }
    z = table_[0];
    return difference(z, before);
  }

 private:
  static constexpr int kColumns = 10;

  /// Gragg's smoothed midpoint rule with n steps.
  Motion midpointRule(const Motion& start, Real h, int n) {
    h /= n;
    Motion old = start;
    model_.acceleration(old, a_);
    Motion now{start.p + h * start.v, start.v + h * a_};
    for (int s = 1; s < n; ++s) {
      model_.acceleration(now, a_);
      Motion next{old.p + 2 * h * now.v, old.v + 2 * h * a_};
      old = std::move(now);
      now = std::move(next);
    }
    model_.acceleration(now, a_);
    return {(old.p + now.p + h * now.v) / 2, (old.v + now.v + h * a_) / 2};
  }

  const Model& model_;
  Vector a_;
  std::array<Motion, kColumns> table_;
};

/// P_s(x) - P_(s-1)(x) at x = 2 c - 1, with the Legendre polynomials P.
Real radauPolynomial(int s, Real c) {
  const Real x = 2 * c - 1;
  Real before = 1;
  Real now = x;
  for (int k = 2; k <= s; ++k) {
    const Real next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
    before = now;
    now = next;
  }
  return now - before;
}

/// The roots of the Radau polynomial in rising order.
Vector radauNodes(int stages) {
  constexpr int kParts = 1000;
  Vector nodes = Vector::Ones(stages);
  int found = 0;
  for (int i = 0; i < kParts && found + 1 < stages; ++i) {
    Real least = Real(i) / kParts;
    Real most = Real(i + 1) / kParts;
    const bool below = radauPolynomial(stages, least) < 0;
    if ((radauPolynomial(stages, most) < 0) == below) continue;
    for (int n = 0; n < 64; ++n) {
      const Real middle = (least + most) / 2;
      ((radauPolynomial(stages, middle) < 0) == below ? least : most) = middle;
    }
    nodes[found++] = least;
  }
  return nodes;
}

/// The collocation method with these nodes: sum_j a_ij c_j^(k-1) = c_i^k / k.
Matrix collocation(const Vector& nodes) {
  const Eigen::Index stages = nodes.size();
  Matrix powers(stages, stages);
  Matrix integrals(stages, stages);
  Vector power = Vector::Ones(stages);
  for (Eigen::Index k = 0; k < stages; ++k) {
    powers.row(k) = power.transpose();
    power = power.cwiseProduct(nodes);
    integrals.row(k) = power.transpose() / Real(k + 1);
  }
  return powers.fullPivLu().solve(integrals).transpose();
}

/// Radau IIA with five stages. Unknowns of a stage: the velocities V and the tensions T;
///
///     0 = m (V_i - v) - h sum_j a_ij F(P_j, T_j) ,   P_i = p + h sum_j a_ij V_j ,
///     0 = k_s (L - L_0) + k_d L' - T .
class Radau {
 public:
  static constexpr Real kTolerance = 2e-14L;
  static constexpr int kOrder = 9;

  explicit Radau(const Model& model)
      : model_(model), unknowns_(3 * model.size), a_(collocation(radauNodes(kStages))) {}

  double secondsPerStep() const {
    return 6.0 * std::pow(kStages * static_cast<double>(unknowns_) + 10.0, 3) / kFlopsPerSecond;
  }

  /// Advances z by two halves of h; returns the difference to a single step.
  Real step(Motion& z, Real h) {
    Motion once = z;
    Motion twice = z;
    if (!solve(once, h) || !solve(twice, h / 2) || !solve(twice, h / 2)) return 1e30L;
    z = twice;
    return difference(once, twice);
  }

 private:
  static constexpr int kStages = 5;
  static constexpr int kReuses = 4, kIterations = 24;

  bool solve(Motion& z, Real h) {
    Vector first(unknowns_);
    first.head(2 * model_.size) = z.v;
    for (Eigen::Index s = 0; s < model_.size; ++s) {
      first[2 * model_.size + s] = model_.tension(model_.spring(z, s));
    }
    Vector x = first.replicate(kStages, 1);
    Real last = 1e30L;
    for (int n = 0; n < kIterations; ++n) {
      const Vector correction = newton(z, h, x, n % kReuses == 0);
      if (!correction.allFinite()) return false;
      x -= correction;
      Real size = 0;
      for (int i = 0; i < kStages; ++i) {
        const auto velocities = correction.segment(i * unknowns_, 2 * model_.size);
        size = std::max(size, velocities.lpNorm<Eigen::Infinity>());
      }
      // The residual is small enough, or rounding errors prevent a smaller one.
      if (size < 1e-17L || (size < 1e-12L && size > 0.1L * last)) {
        z = {stage(z, h, x, kStages - 1).p, stage(z, h, x, kStages - 1).v};
        return true;
      }
      last = size;
    }
    return false;
  }

  Motion stage(const Motion& z, Real h, const Vector& x, int i) const {
    Motion result{z.p, x.segment(i * unknowns_, 2 * model_.size)};
    for (int j = 0; j < kStages; ++j) {
      result.p += h * a_(i, j) * x.segment(j * unknowns_, 2 * model_.size);
    }
    return result;
  }

  /// J^-1 times the residual, with the Jacobian of this or an earlier iterate.
  Vector newton(const Motion& z, Real h, const Vector& x, bool renew) {
    Matrix jacobian = Matrix::Zero(x.size(), x.size());
    Vector residual = Vector::Zero(x.size());
    for (int i = 0; i < kStages; ++i) {
      for (Eigen::Index k = 0; k < 2 * model_.size; ++k) {
        const Eigen::Index row = i * unknowns_ + k;
        const Real mass = model_.masses[k / 2];
        jacobian(row, row) += mass;
        residual[row] += mass * (x[row] - z.v[k]);
        if (k % 2 == 1) residual[row] += h * a_.row(i).sum() * mass * model_.gravity;
      }
    }
    for (int j = 0; j < kStages; ++j) {
      const Motion at = stage(z, h, x, j);
      for (Eigen::Index s = 0; s < model_.size; ++s) addSpring(at, h, x, j, s, residual, jacobian);
    }
    if (renew) factors_.compute(jacobian);
    return factors_.solve(residual);
  }

  void addSpring(const Motion& at, Real h, const Vector& x, int j, Eigen::Index s, Vector& residual,
                 Matrix& jacobian) const {
    const Eigen::Index row = j * unknowns_ + 2 * model_.size + s;
    const Spring spring = model_.spring(at, s);
    const Real tension = x[row];
    const Eigen::Matrix<Real, 2, 2> across =
        (Eigen::Matrix<Real, 2, 2>::Identity() - spring.direction * spring.direction.transpose()) /
        spring.length;
    residual[row] = model_.tension(spring) - tension;
    jacobian(row, row) = -1;
    const Pair by_place =
        model_.stiffness * spring.direction + model_.damping * across * spring.velocity;
    const auto each_end = [&](const auto& visit) {
      visit(2 * s, Real(1));
      if (s > 0) visit(2 * s - 2, Real(-1));
    };
    each_end([&](Eigen::Index end, Real sign) {
      const Eigen::Index own = j * unknowns_ + end;
      jacobian.template block<1, 2>(row, own) +=
          sign * model_.damping * spring.direction.transpose();
      for (int i = 0; i < kStages; ++i) {
        const Eigen::Index other = i * unknowns_ + end;
        jacobian.template block<1, 2>(row, other) += sign * h * a_(j, i) * by_place.transpose();
        // The force on this end is -sign T r.
        residual.template segment<2>(other) += h * a_(i, j) * sign * tension * spring.direction;
        jacobian.template block<2, 1>(other, row) += h * a_(i, j) * sign * spring.direction;
        each_end([&](Eigen::Index far, Real far_sign) {
          for (int k = 0; k < kStages; ++k) {
            jacobian.template block<2, 2>(other, k * unknowns_ + far) +=
                h * a_(i, j) * sign * far_sign * tension * h * a_(j, k) * across;
          }
        });
      }
    });
  }

  const Model& model_;
  Eigen::Index unknowns_;
  Matrix a_;
  Eigen::PartialPivLU<Matrix> factors_;
};

State toState(const Motion& z, const State& start) {
  State state = start;
  for (Eigen::Index i = 1; i < start.size(); ++i) {
    for (int column = 0; column < 2; ++column) {
      state.values()(i, column) = static_cast<double>(z.p[2 * i - 2 + column]);
      state.values()(i, 2 + column) = static_cast<double>(z.v[2 * i - 2 + column]);
    }
  }
  return state;
}

Motion toMotion(const State& start, double perturbation) {
  const Eigen::Index size = start.size() - 1;
  Motion z{Vector(2 * size), Vector(2 * size)};
  std::mt19937 random(1);
  for (Eigen::Index i = 0; i < 2 * size; ++i) {
    const Real uniform = Real(random()) / 2147483648.0L - 1;
    z.p[i] = start.values()(1 + i / 2, i % 2) + perturbation * uniform;
    z.v[i] = start.values()(1 + i / 2, 2 + i % 2);
  }
  return z;
}

template <typename Method>
std::optional<std::vector<State>> run(Method method, Motion z, const State& start, double interval,
                                      int outputs, double budget) {
  std::vector<State> states;
  Real h = 1e-9L;
  Real left = interval;  // time left until the next output
  while (static_cast<int>(states.size()) < outputs) {
    budget -= method.secondsPerStep();
    if (budget < 0.0 || h < 1e-16L) return std::nullopt;
    const bool last = h >= left;
    const Real tried = last ? left : h;
    Motion next = z;
    const Real ratio = std::max(method.step(next, tried) / Method::kTolerance, Real(1e-30L));
    const Real factor = std::clamp(Real(0.9L) * std::pow(ratio, Real(-1) / (Method::kOrder + 1)),
                                   Real(0.2L), Real(4));
    if (ratio > 1) {
      h = tried * std::min(factor, Real(0.8L));
      continue;
    }
    z = std::move(next);
    left -= tried;
    if (last) {
      states.push_back(toState(z, start));
      left = interval;
    }
    if (!last || factor < 1) h = tried * factor;
  }
  return states;
}

}  // namespace

OracleMethod oracleMethodFor(const Scene& scene) {
  double mobility = 0.0;
  for (Eigen::Index i = 1; i < scene.chain.size(); ++i) {
    mobility = std::max(mobility, 4.0 * scene.chain.inverseMasses()[i]);
  }
  // Measured work for one second: the first method takes steps of 5/rate, the second about 100.
  const double rate = scene.chain.spring().damping * mobility;
  const Model model(scene.chain, Pair(0, 0));
  const double extrapolation = 0.2 * rate * Extrapolation(model).secondsPerStep();
  const double radau = 100.0 * Radau(model).secondsPerStep();
  return extrapolation > radau ? OracleMethod::kRadau : OracleMethod::kExtrapolation;
}

std::optional<std::vector<State>> solveExactly(const Scene& scene, double interval, int outputs,
                                               double budget, OracleMethod method,
                                               double perturbation) {
  const Model model(scene.chain, Pair(scene.start.x()[0], scene.start.y()[0]));
  const Motion z = toMotion(scene.start, perturbation);
  if (method == OracleMethod::kRadau) {
    return run(Radau(model), z, scene.start, interval, outputs, budget);
  }
  return run(Extrapolation(model), z, scene.start, interval, outputs, budget);
}

std::optional<ExactMotion> exactMotion(const Scene& scene, double interval, int outputs,
                                       double budget) {
  const OracleMethod method = oracleMethodFor(scene);
  auto states = solveExactly(scene, interval, outputs, budget / 2, method);
  if (!states) return std::nullopt;
  const auto near = solveExactly(scene, interval, outputs, budget / 2, method, kPerturbation);
  if (!near) return std::nullopt;
  ExactMotion motion{std::move(*states), 0.0};
  for (std::size_t i = 0; i < motion.states.size(); ++i) {
    const double grown =
        (motion.states[i].positions() - (*near)[i].positions()).cwiseAbs().maxCoeff();
    motion.growth = std::max(motion.growth, grown / kPerturbation);
  }
  return motion;
}

}  // namespace spring_pendulum::test
