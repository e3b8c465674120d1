#include "support/exact_motion.hpp"

#include <spring_pendulum/integration/method_table.hpp>

#include <algorithm>
#include <memory>
#include <random>
#include <utility>

#include "support/precise_motion.hpp"

namespace spring_pendulum::test {
namespace {

constexpr double kWorkPerSecond = 2e7;  // particles x evaluations
constexpr double kPerturbation = 1e-9;  // m

class StiffMotion {
 public:
  explicit StiffMotion(const Scene& scene)
      : state_(scene.start),
        integrator_(makeIntegrator(
            "Radau-9", scene.chain,
            {std::max(1e-11, smallestTolerance(scene.chain, scene.start)), false, 1})) {}

  bool advance(double seconds, double most_work) {
    const auto stop = [&] { return integrator_->work() > most_work; };
    return integrator_->advance(state_, seconds, 1, stop) == 1;
  }
  const State& state() const { return state_; }

 private:
  State state_;
  std::unique_ptr<Integrator> integrator_;
};

/// Follows a motion and one from a slightly different start.
template <typename Motion>
std::optional<ExactMotion> follow(Motion motion, Motion near, double interval, int outputs,
                                  double most_work) {
  ExactMotion exact;
  for (int i = 0; i < outputs; ++i) {
    if (!motion.advance(interval, most_work) || !near.advance(interval, most_work)) return {};
    exact.states.push_back(motion.state());
    const double grown =
        (motion.state().positions() - near.state().positions()).cwiseAbs().maxCoeff();
    exact.growth = std::max(exact.growth, grown / kPerturbation);
  }
  return exact;
}

}  // namespace

std::optional<ExactMotion> exactMotion(const Scene& scene, double interval, int outputs,
                                       double budget) {
  Scene near = scene;
  std::mt19937 random(1);
  for (Eigen::Index i = 1; i < near.start.size(); ++i)
    for (const int column : {0, 1}) {
      const double uniform = static_cast<double>(random()) / 2147483648.0 - 1.0;
      near.start.values()(i, column) += kPerturbation * uniform;
    }
  using Motion = ExtrapolatedMotion<long double, 10>;
  auto exact =
      follow(Motion(scene), Motion(near), interval, outputs, 0.5 * kWorkPerSecond * budget);
  if (exact) return exact;
  return follow(StiffMotion(scene), StiffMotion(near), interval, outputs, 0.5 * budget);
}

}  // namespace spring_pendulum::test
