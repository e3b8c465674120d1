// The library against closed forms from the literature: docs/verification.md has a row for each suite.
// Only the library's public interface is used, and every expected value is computed here from its formula.
#include <spring_pendulum/spring_pendulum.hpp>

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kG = 9.81;  // m/s²

Chain chainOf(Eigen::Index size, double mass, const SpringLaw& spring) {
  return {Eigen::VectorXd::Constant(size, mass), spring, kG};
}

/// A chain hanging straight down from the origin with springs of their rest length.
State hangingUnstretched(Eigen::Index size, double rest_length) {
  State state(size);
  for (Eigen::Index i = 0; i < size; ++i) state.y()[i] = -rest_length * static_cast<double>(i);
  return state;
}

double largestDistance(const State& a, const State& b) {
  return (a.positions() - b.positions()).rowwise().norm().maxCoeff();
}

/// Motion of n equal masses below a fixed end, linear at any amplitude while no spring turns over:
/// mode j has the shape sin((2j-1)πi/(2n+1)), ω_j² = λ_j k_s/m and the damping rate λ_j k_d/(2m), where
/// λ_j = 4 sin²((2j-1)π/(2(2n+1))). The masses start at rest at the distances `start` from equilibrium.
class HangingModes {
 public:
  HangingModes(const Chain& chain, const Eigen::VectorXd& start)
      : shapes_(start.size(), start.size()), squares_(start.size()), rates_(start.size()) {
    const Eigen::Index size = start.size();
    const double whole = 2.0 * static_cast<double>(size) + 1.0;
    for (Eigen::Index j = 0; j < size; ++j) {
      const double angle = (2.0 * static_cast<double>(j) + 1.0) * kPi / whole;
      for (Eigen::Index i = 0; i < size; ++i)
        shapes_(i, j) = std::sin(angle * static_cast<double>(i + 1));
      const double lambda = 4.0 * std::pow(std::sin(0.5 * angle), 2);
      squares_[j] = lambda * chain.spring().stiffness / chain.masses()[1];
      rates_[j] = 0.5 * lambda * chain.spring().damping / chain.masses()[1];
    }
    amplitudes_ = shapes_.transpose() * start * (4.0 / whole);
  }

  /// Distances from equilibrium at `time`, m.
  Eigen::VectorXd at(double time) const {
    Eigen::VectorXd now = amplitudes_;
    for (Eigen::Index j = 0; j < now.size(); ++j) {
      const double rate = rates_[j];
      const double omega = std::sqrt(squares_[j] - rate * rate);  // no mode is overdamped
      now[j] *=
          std::exp(-rate * time) * (std::cos(omega * time) + rate / omega * std::sin(omega * time));
    }
    return shapes_ * now;
  }

 private:
  Eigen::MatrixXd shapes_;
  Eigen::VectorXd squares_, rates_, amplitudes_;
};

/// Stretch of the chain that hangs at rest: the distance of each mass from its place without gravity, m.
Eigen::VectorXd staticStretch(const Chain& chain) {
  Eigen::VectorXd stretch(chain.size() - 1);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < stretch.size(); ++i) {
    sum +=
        static_cast<double>(stretch.size() - i) * chain.masses()[1] * kG / chain.spring().stiffness;
    stretch[i] = sum;
  }
  return stretch;
}

/// Error of a chain that is let go with unstretched springs, m.
double errorOfHangingChain(const Chain& chain, const char* method, double tolerance, double step,
                           double duration) {
  const Eigen::VectorXd stretch = staticStretch(chain);
  const HangingModes modes(chain, stretch);
  State state = hangingUnstretched(chain.size(), chain.spring().rest_length);
  State exact = state;
  makeIntegrator(method, chain, {tolerance})->advance(state, step, std::lround(duration / step));
  exact.y().tail(stretch.size()) += modes.at(duration) - stretch;
  return largestDistance(state, exact);
}

struct HangingRow {
  Eigen::Index masses;
  SpringLaw spring;
  double mass;  // kg
};

class HangingChain : public testing::TestWithParam<HangingRow> {};

// Measured, m: Taylor-12 1.6e-13, 2.6e-14, 4.5e-13, 2.1e-13, Auto 1.4e-12, 2.9e-13, 2.6e-13, 1.4e-13.
TEST_P(HangingChain, MovesAsItsModes) {
  const auto& [masses, spring, mass] = GetParam();
  const Chain chain = chainOf(masses + 1, mass, spring);
  EXPECT_LT(errorOfHangingChain(chain, "Taylor-12", 1e-10, 0.5, 20.0), 1e-12);
  EXPECT_LT(errorOfHangingChain(chain, "Auto", 1e-9, 0.5, 20.0), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Masses, HangingChain,
                         testing::Values(HangingRow{10, {1000.0, 0.0, 1.0}, 1.0},
                                         HangingRow{10, {1000.0, 1.0, 1.0}, 1.0},
                                         HangingRow{1000, {1e4, 0.0, 1e-3}, 1e-3},
                                         HangingRow{1000, {1e4, 1e-3, 1e-3}, 1e-3}));

/// The slope of the error from a step to half of it.
double orderOnHangingChain(const Chain& chain, const char* method, double step) {
  return std::log2(errorOfHangingChain(chain, method, 1.0, step, 20.0) /
                   errorOfHangingChain(chain, method, 1.0, 0.5 * step, 20.0));
}

TEST(OrderOnHangingChain, IsThatOfEachMethod) {
  const Chain small = chainOf(11, 1.0, {1000.0, 1.0, 1.0});
  EXPECT_NEAR(orderOnHangingChain(small, "Euler", 1e-4), 1.0, 0.05);  // 1.007, 0.993, 1.995
  EXPECT_NEAR(orderOnHangingChain(small, "Backward-Euler", 1e-4), 1.0, 0.05);
  EXPECT_NEAR(orderOnHangingChain(small, "Runge-Kutta-2", 1e-3), 2.0, 0.05);
  for (const double damping : {0.0, 1.0})
    for (const Eigen::Index masses : {10, 1000}) {
      const double stiffness = masses == 10 ? 1000.0 : 1e4;  // no spring turns over
      const Chain chain = chainOf(masses + 1, 1.0, {stiffness, damping, 1.0});
      const double step = masses == 10 ? 4e-3 : 1e-3;  // measured: 4.03, 3.98, 4.01, 4.01
      EXPECT_NEAR(orderOnHangingChain(chain, "Runge-Kutta-4", step), 4.0, 0.05) << masses;
    }
}

/// Angular frequencies of small sideways swings and their shapes: a weight W_i below spring i, of length
/// l_i = a + W_i/k_s, pulls back with W_i/l_i.
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> swingingModes(const Chain& chain) {
  const Eigen::Index masses = chain.size() - 1;
  const double mass = chain.masses()[1];
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(masses, masses);
  for (Eigen::Index i = 0; i < masses; ++i) {
    const double weight = static_cast<double>(masses - i) * mass * kG;
    const double length = chain.spring().rest_length + weight / chain.spring().stiffness;
    matrix(i, i) += weight / length / mass;
    if (i == 0) continue;
    matrix(i - 1, i - 1) += weight / length / mass;
    matrix(i, i - 1) = matrix(i - 1, i) = -weight / length / mass;
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix);
}

/// Largest relative deviation from the start after five periods of a mode.
double deviationAfterFivePeriods(const Chain& chain, double omega, const Eigen::VectorXd& shape) {
  constexpr double kAmplitude = 1e-6;  // m
  State state = equilibrium(chain, hangingUnstretched(chain.size(), chain.spring().rest_length));
  state.x().tail(shape.size()) = kAmplitude * shape / shape.cwiseAbs().maxCoeff();
  const State start = state;
  makeIntegrator("Taylor-12", chain, {1e-14})->advance(state, 10.0 * kPi / omega, 1);
  return (state.x() - start.x()).cwiseAbs().maxCoeff() / kAmplitude +
         state.vx().cwiseAbs().maxCoeff() / (kAmplitude * omega);
}

TEST(SwingingModes, FollowTheLaguerrePolynomial) {
  // Zeros of L_3, M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 1964, table 25.9.
  const Eigen::VectorXd zeros = swingingModes(chainOf(4, 1.0, {1e12, 0.0, 1.0})).eigenvalues() / kG;
  EXPECT_NEAR(zeros[0], 0.415775, 1e-6);
  EXPECT_NEAR(zeros[1], 2.294280, 1e-6);
  EXPECT_NEAR(zeros[2], 6.289945, 1e-6);
  const Chain chain = chainOf(11, 0.1, {1e4, 0.0, 0.1});
  const auto elastic = swingingModes(chain);
  const double expected[] = {3.665948928, 8.442429017, 13.293160365};  // rad/s
  for (Eigen::Index j = 0; j < 3; ++j) {
    const double omega = std::sqrt(elastic.eigenvalues()[j]);
    EXPECT_NEAR(omega, expected[j], 1e-9);
    // Measured 1.0e-9, 1.6e-9, 5.6e-9.
    EXPECT_LT(deviationAfterFivePeriods(chain, omega, elastic.eigenvectors().col(j)), 1e-8);
  }
}

/// Angular frequencies of small sideways swings of a chain of 1 m, rad/s, by the library's accelerations.
Eigen::VectorXd frequencies(Eigen::Index masses) {
  const auto n = static_cast<double>(masses);
  const Chain chain = chainOf(masses + 1, 1.0 / n, {1e8, 0.0, 1.0 / n});
  const State rest = equilibrium(chain, hangingUnstretched(chain.size(), 1.0 / n));
  constexpr double kMove = 1e-9;  // m
  Eigen::MatrixXd matrix(masses, masses);
  State slope;
  for (Eigen::Index i = 0; i < masses; ++i) {
    State moved = rest;
    moved.x()[i + 1] = kMove;
    computeSlope(chain, moved, slope);
    matrix.col(i) = -slope.vx().tail(masses) / kMove;
  }
  Eigen::VectorXd squares = matrix.eigenvalues().real();
  std::sort(squares.data(), squares.data() + masses);
  return squares.cwiseSqrt();
}

TEST(SwingingModes, ConvergeToTheContinuousChainWithOrder1) {
  const Eigen::Vector3d zeros(2.404825557695773, 5.520078110286311, 8.653727912911012);  // of J_0
  const Eigen::Array3d limits = 0.5 * std::sqrt(kG) * zeros;
  EXPECT_LT((limits - Eigen::Array3d(3.76607, 8.64470, 13.55214)).abs().maxCoeff(), 1e-5);
  const auto share = [&](Eigen::Index masses) -> Eigen::Array3d {
    return frequencies(masses).head(3).array() / limits;
  };
  EXPECT_NEAR(share(10)[0], 0.97625, 1e-5);
  EXPECT_NEAR(share(100)[0], 0.99751, 1e-5);
  const Eigen::Array3d orders = ((1.0 - share(80)) / (1.0 - share(160))).log() / std::log(2.0);
  EXPECT_LT((orders - 1.0).abs().maxCoeff(), 0.04);  // measured 0.033
}

// code_aster V6.02.114: cable element under its own weight.
TEST(ElasticCatenary, IsReachedWithOrder2) {
  constexpr double kLength = 325.0;              // m, also the span
  constexpr double kAxial = 5.7e10 * 2.2783e-4;  // N
  constexpr double kLine = 2844.23 * 2.2783e-4;  // kg/m
  constexpr double kWeight = kLine * kG;         // N/m
  const auto span = [&](double force) {
    return 2.0 * force / kWeight * std::asinh(kWeight * kLength / (2.0 * force)) +
           force * kLength / kAxial;
  };
  double low = 1e3, high = 1e6;  // N, of the horizontal force, with which the span grows
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (span(middle) < kLength ? low : high) = middle;
  }
  const double ratio = kWeight * kLength / (2.0 * low);
  const double sag = low / kWeight * (std::sqrt(1.0 + ratio * ratio) - 1.0) +
                     kWeight * kLength * kLength / (8.0 * kAxial);
  EXPECT_NEAR(low, 13206.239, 1e-3);
  EXPECT_NEAR(sag, 6.352161470, 1e-9);
  double before = 0.0;
  for (Eigen::Index springs = 10; springs <= 1280; springs *= 2) {
    const auto n = static_cast<double>(springs);
    const Chain chain =
        chainOf(springs + 1, kLine * kLength / n, {kAxial * n / kLength, 0.0, kLength / n})
            .drivenBy({{{springs, {}}}, {}});
    State ends(springs + 1);
    ends.x()[springs] = kLength;
    const double error = std::abs(equilibrium(chain, ends).y()[springs / 2] + sag);
    if (before > 0.0) {
      EXPECT_NEAR(std::log2(before / error), 2.0, 0.1) << springs;  // 2.007 to 2.000
    }
    before = error;
  }
  EXPECT_LT(before, 1.3e-6);  // m, measured 1.293e-6
}

TEST(PendulumFromTheHorizontal, ReturnsAfterItsPeriod) {
  double a = 1.0, b = std::sqrt(0.5);  // K(1/2) = π/(2 M(1, √½)), M the arithmetic-geometric mean
  for (int i = 0; i < 6; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  const double period = 4.0 * std::sqrt(1.0 / kG) * kPi / (2.0 * a);
  EXPECT_NEAR(period, 2.36784194757624, 1e-14);
  const Chain chain = chainOf(2, 1.0, {1e8, 0.0, 1.0});
  State state(2);
  state.x()[1] = 1.0;
  const State start = state;
  makeIntegrator("Taylor-12", chain, {1e-12})->advance(state, period, 1);
  EXPECT_LT(largestDistance(state, start), 1e-10);  // m, measured 8e-13
}

// A hanging chain whose anchor falls: seen from the anchor, its modes without gravity.
TEST(FallingAnchor, LeavesTheTipAtRestUntilTheWaveArrives) {
  constexpr Eigen::Index kMasses = 30;
  const Chain hanging = chainOf(kMasses + 1, 0.1, {500.0, 0.0, 1.0});
  const State unstretched = hangingUnstretched(kMasses + 1, 1.0);
  const State rest = equilibrium(hanging, unstretched);
  const Chain falling = hanging.drivenBy({{{0, {0.0, -kG}}}, {}});
  const HangingModes modes(hanging, staticStretch(hanging));
  const double arrival = kMasses * std::sqrt(0.1 / 500.0);  // s, N √(m/k_s)
  for (const double time : {0.5 * arrival, arrival, 3.0 * arrival}) {
    State state = rest;
    makeIntegrator("Taylor-12", falling, {1e-12})->advance(state, time, 1);
    State exact = unstretched;
    exact.y().tail(kMasses) -= modes.at(time);
    exact.y().array() -= 0.5 * kG * time * time;
    EXPECT_LT(largestDistance(state, exact), 1e-9) << time;  // m, measured 2e-14
    const double moved = rest.y()[kMasses] - state.y()[kMasses];
    EXPECT_TRUE(time < arrival ? moved < 1e-9 : time == arrival || moved > 1.0)
        << moved;  // m, 1e-14, 6.9
  }
}

struct Fall {
  double time;     ///< of the tip until it turns, relative to a free fall
  double tension;  ///< largest at the anchor, in weights of the chain
};

/// A chain of 1 m and 1 kg, folded with both ends at the same height, whose tip is let go.
Fall fallOfFoldedChain(Eigen::Index size) {
  const auto springs = static_cast<double>(size - 1);
  const Chain chain = chainOf(size, 1.0 / springs, {1e4 * springs, 0.0, 1.0 / springs});
  State state(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    state.x()[i] = i < size / 2 ? 0.0 : 1.0 / springs;
    state.y()[i] = -static_cast<double>(std::min(i, size - 1 - i)) / springs;
  }
  const auto integrator = makeIntegrator("Taylor-8", chain, {1e-6});
  constexpr int kParts = 1000;
  Fall fall{0.0, 0.0};
  for (int part = 1; part <= kParts; ++part) {
    integrator->advance(state, std::sqrt(2.0 / kG) / kParts, 1);
    const PlaneVector<double> force = springForceOn(chain, state, 0);
    fall.tension = std::max(
        fall.tension, std::hypot(force.x, force.y) / (static_cast<double>(size) * kG / springs));
    const bool turned = part > kParts / 2 && state.vy()[size - 1] > 0.0;
    if (turned && fall.time == 0.0) fall.time = static_cast<double>(part) / kParts;
  }
  return fall;
}

// M. G. Calkin, R. H. March, Am. J. Phys. 57 (1989) 154-157: a chain takes 0.847213 of a stone's time.
TEST(FoldedChain, FallsFasterThanAStone) {
  double before = 1.0;
  for (const Eigen::Index size : {20, 50, 100, 200}) {
    const Fall fall = fallOfFoldedChain(size);
    EXPECT_GT(fall.time, 0.847) << size;  // measured 0.901, 0.871, 0.861, 0.855
    EXPECT_LT(fall.time, before) << size;
    EXPECT_GT(fall.tension, 20.0) << size;  // measured 29, 56, 79, 105
    before = fall.time;
  }
  EXPECT_LT(before, 0.86);
}

}  // namespace
}  // namespace spring_pendulum
