// Computes a reference solution: the Taylor series method of order 14 with a fixed step in extended
// precision (64 bits of mantissa). Shares no code with the package.
//
// usage: taylor_reference PARTICLES STEPS_PER_SECOND SECONDS OUTPUT_PREFIX
// Reads lines "x y m" (every number as the nearest double), starts at rest with the default
// constants, and writes a line "x y vx vy" per particle to OUTPUT_PREFIX_t1.txt, _t2.txt, ...
//
// With d the separation of a spring's ends, L its length and T = k_s (L - 1) + k_d L' its tension,
// the force is (T/L) d. Each of these is a series in t; products and quotients of series follow
// from their coefficients (R. E. Moore, Methods and Applications of Interval Analysis, SIAM 1979,
// section 3.4).
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

namespace {

using Real = long double;
constexpr int kOrder = 14;
using Series = std::array<Real, kOrder + 2>;

constexpr Real kStiffness = 50.0L;
constexpr Real kDamping = 1.0L;
const Real kGravity = 9.81;  // the nearest double, as everywhere

struct Particle {
  Real mass = 1.0L;
  Series x{}, y{};                         // coefficient 0 is the position, 1 the velocity
  std::array<Real, 2> lost_x{}, lost_y{};  // rounding errors of these two
};

struct Spring {
  Series dx{}, dy{}, length{}, ratio{};  // ratio = tension / length
  Series fx{}, fy{};
};

// Coefficient n of a product.
Real product(const Series& a, const Series& b, int n) {
  Real sum = 0.0L;
  for (int j = 0; j <= n; ++j) sum += a[j] * b[n - j];
  return sum;
}

// Coefficient n of the force, from the separation's coefficients up to n + 1.
void extendForce(Spring& s, int n) {
  if (n == 0) s.length[0] = std::sqrt(s.dx[0] * s.dx[0] + s.dy[0] * s.dy[0]);
  Real square = product(s.dx, s.dx, n + 1) + product(s.dy, s.dy, n + 1);
  for (int j = 1; j <= n; ++j) square -= s.length[j] * s.length[n + 1 - j];
  s.length[n + 1] = square / (2.0L * s.length[0]);
  Real tension = kStiffness * (s.length[n] - (n == 0 ? 1.0L : 0.0L)) +
                 kDamping * static_cast<Real>(n + 1) * s.length[n + 1];
  for (int j = 0; j < n; ++j) tension -= s.ratio[j] * s.length[n - j];
  s.ratio[n] = tension / s.length[0];
  s.fx[n] = product(s.ratio, s.dx, n);
  s.fy[n] = product(s.ratio, s.dy, n);
}

// sum += term with compensated summation (Kahan).
void addExactly(Real& sum, Real& lost, Real term) {
  const Real wanted = term + lost;
  const Real rounded = sum + wanted;
  lost = wanted - (rounded - sum);
  sum = rounded;
}

void advance(Series& s, std::array<Real, 2>& lost, Real h) {
  Real position = 0.0L;
  Real velocity = 0.0L;
  for (int k = kOrder; k >= 1; --k) {
    if (k > 1) velocity = (velocity + static_cast<Real>(k) * s[k]) * h;
    position = (position + s[k]) * h;
  }
  addExactly(s[0], lost[0], position + h * lost[1]);
  addExactly(s[1], lost[1], velocity);
}

void step(std::vector<Particle>& particles, std::vector<Spring>& springs, Real h) {
  const std::size_t count = particles.size();
  for (int n = 0; n + 2 < kOrder + 2; ++n) {
    for (std::size_t i = 0; i + 1 < count; ++i) {
      for (int k = n == 0 ? 0 : n + 1; k <= n + 1; ++k) {
        springs[i].dx[k] = particles[i + 1].x[k] - particles[i].x[k];
        springs[i].dy[k] = particles[i + 1].y[k] - particles[i].y[k];
        if (k > 1) continue;
        springs[i].dx[k] += particles[i + 1].lost_x[k] - particles[i].lost_x[k];
        springs[i].dy[k] += particles[i + 1].lost_y[k] - particles[i].lost_y[k];
      }
      extendForce(springs[i], n);
    }
    const Real scale = 1.0L / static_cast<Real>((n + 1) * (n + 2));
    for (std::size_t i = 1; i < count; ++i) {
      Particle& p = particles[i];
      const bool last = i + 1 == count;
      const Real fx = (last ? 0.0L : springs[i].fx[n]) - springs[i - 1].fx[n];
      const Real fy = (last ? 0.0L : springs[i].fy[n]) - springs[i - 1].fy[n];
      p.x[n + 2] = scale * (fx / p.mass);
      p.y[n + 2] = scale * (fy / p.mass - (n == 0 ? kGravity : 0.0L));
    }
  }
  for (std::size_t i = 1; i < count; ++i) {
    advance(particles[i].x, particles[i].lost_x, h);
    advance(particles[i].y, particles[i].lost_y, h);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: taylor_reference PARTICLES STEPS_PER_SECOND SECONDS OUTPUT_PREFIX\n";
    return 2;
  }
  std::vector<Particle> particles;
  std::ifstream file(argv[1]);
  for (double x = 0.0, y = 0.0, mass = 0.0; file >> x >> y >> mass;) {
    Particle particle;
    particle.mass = mass;
    particle.x[0] = x;
    particle.y[0] = y;
    particles.push_back(particle);
  }
  if (particles.empty()) {
    std::cerr << argv[1] << ": no particles\n";
    return 1;
  }
  std::vector<Spring> springs(particles.size());
  const long steps = std::atol(argv[2]);
  for (long second = 1; second <= std::atol(argv[3]); ++second) {
    for (long n = 0; n < steps; ++n) step(particles, springs, 1.0L / static_cast<Real>(steps));
    std::ofstream out(argv[4] + ("_t" + std::to_string(second) + ".txt"));
    out << std::setprecision(21);
    for (const Particle& p : particles) {
      out << p.x[0] << ' ' << p.y[0] << ' ' << p.x[1] << ' ' << p.y[1] << '\n';
    }
  }
}
