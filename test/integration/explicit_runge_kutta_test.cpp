// What every fixed-step method promises besides its order.
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

using test::referenceScene;
using test::Scene;

bool sameBits(const State& a, const State& b) {
  return a.size() == b.size() &&
         std::memcmp(a.values().data(), b.values().data(),
                     sizeof(double) * static_cast<std::size_t>(a.values().size())) == 0;
}

class FixedStepMethod : public testing::TestWithParam<const Method*> {
 protected:
  const Scene scene_ = referenceScene("horizontal_11");
  const std::unique_ptr<Integrator> integrator_ = makeIntegrator(GetParam()->name, scene_.chain);
};

TEST_P(FixedStepMethod, EvaluatesTheForceOnceAStage) {
  State state = scene_.start;
  integrator_->advance(state, 0.01, 7);
  EXPECT_EQ(integrator_->forceEvaluations(), 7 * GetParam()->stages);
}

TEST_P(FixedStepMethod, NeverMovesTheFirstParticleByABit) {
  State state = scene_.start;
  state.x()[0] = 0.1;
  state.y()[0] = -0.3;
  const auto first = state.values().row(0).eval();
  integrator_->advance(state, 0.01, 100);
  EXPECT_EQ(std::memcmp(first.data(), state.values().row(0).eval().data(), sizeof(double) * 4), 0);
  EXPECT_GT((state.positions() - scene_.start.positions()).norm(), 1.0);
}

TEST_P(FixedStepMethod, TakesTheSameStepsInOneCallOrInMany) {
  State at_once = scene_.start;
  integrator_->advance(at_once, 0.01, 30);
  State one_by_one = scene_.start;
  for (int n = 0; n < 30; ++n) integrator_->advance(one_by_one, 0.01, 1);
  EXPECT_TRUE(sameBits(at_once, one_by_one));
}

TEST_P(FixedStepMethod, MirrorsAMirroredScene) {
  State state = scene_.start;
  integrator_->advance(state, 0.01, 100);
  State mirrored = scene_.start;
  mirrored.x() *= -1.0;
  integrator_->advance(mirrored, 0.01, 100);
  EXPECT_EQ((mirrored.x() + state.x()).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ((mirrored.y() - state.y()).cwiseAbs().maxCoeff(), 0.0);
}

TEST_P(FixedStepMethod, LeavesASingleParticleAlone) {
  const Chain chain(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  State state(1);
  state.x()[0] = 2.0;
  makeIntegrator(GetParam()->name, chain)->advance(state, 0.01, 10);
  EXPECT_EQ(state.x()[0], 2.0);
  EXPECT_EQ(state.y()[0], 0.0);
}

std::vector<const Method*> fixedStepMethods() {
  std::vector<const Method*> methods;
  for (const Method& method : methodTable()) {
    if (method.control == StepControl::kFixed) methods.push_back(&method);
  }
  return methods;
}

std::string testName(const testing::TestParamInfo<const Method*>& info) {
  std::string name(info.param->name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, FixedStepMethod, testing::ValuesIn(fixedStepMethods()), testName);

}  // namespace
}  // namespace spring_pendulum
