#include "integration/kernels/chain_kernels.hpp"

#include "integration/kernels/kernel_data.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/scene.hpp"

namespace spring_pendulum {
namespace {

constexpr Eigen::Index kSizes[] = {1, 2, 3, 4, 5, 7, 8, 9, 11, 16, 17, 64, 1000};

State randomState(Eigen::Index size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  State state(size);
  for (Eigen::Index i = 0; i < state.values().size(); ++i)
    state.values().data()[i] = number(random);
  state.x() += Eigen::VectorXd::LinSpaced(size, 0.0, static_cast<double>(size - 1));
  state.velocities().row(0).setZero();
  return state;
}

Chain randomChain(Eigen::Index size, const SpringLaw& spring, bool equal_masses, double gravity) {
  Eigen::VectorXd masses = Eigen::VectorXd::Constant(size, 0.7);
  if (!equal_masses)
    masses += 0.5 * Eigen::VectorXd::LinSpaced(size, 0.0, 1.0).array().sin().matrix();
  return {masses, spring, gravity};
}

bool sameBits(const State::Matrix& a, const State::Matrix& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

State::Matrix plusWeighted(State::Matrix sum, double weight, const State::Matrix& slope) {
  for (Eigen::Index i = 0; i < sum.size(); ++i)
    sum.data()[i] = std::fma(weight, slope.data()[i], sum.data()[i]);
  return sum;
}

State::Matrix plainSlope(const Chain& chain, const State& state) {
  State slope;
  computeSlope(chain, state, slope);
  slope.positions() = state.velocities();
  return slope.values();
}

TEST(ChainKernels, StageSlopeHasTheBitsOfThePlainCode) {
  for (const ChainKernels* kernels : supportedChainKernels())
    for (const Eigen::Index size : kSizes) {
      for (const SpringLaw& spring :
           {SpringLaw{}, SpringLaw{200.0, 0.0, 0.3}, SpringLaw{7, 2, 0}}) {
        for (const bool equal_masses : {false, true}) {
          const Chain chain =
              test::inAir(randomChain(size, spring, equal_masses, equal_masses ? 0.0 : 9.81),
                          spring.rest_length == 0.0 ? 0.4 : 0.0);
          const KernelConstants constants(chain);
          State state = randomState(size, 1);
          StateBuffer z(size), k1(size), k2(size), slope(size);
          z.values() = state.values();
          k1.values() = randomState(size, 2).values();
          k2.values() = randomState(size, 3).values();
          const SlopeSum sum{{{0.1, k1.data()}, {-0.03, k2.data()}}, 2};
          kernels->stageSlope(constants.chain(), z.data(), sum, slope.data());
          state.values() = plusWeighted(state.values(), 0.1, k1.values());
          state.values() = plusWeighted(state.values(), -0.03, k2.values());
          const State::Matrix expected = plainSlope(chain, state);
          EXPECT_TRUE(sameBits(slope.values(), expected))
              << kernels->name << ", " << size << " particles, damping " << spring.damping;
        }
      }
    }
}

TEST(ChainKernels, SumsHaveTheBitsOfThePlainCode) {
  for (const ChainKernels* kernels : supportedChainKernels())
    for (const Eigen::Index size : kSizes) {
      StateBuffer z(size), k(size), out(size);
      z.values() = randomState(size, 1).values();
      k.values() = randomState(size, 2).values();
      const SlopeSum sum{{{0.3, k.data()}}, 1};
      kernels->combine(z.pitch(), z.data(), sum, out.data());
      const State::Matrix expected = plusWeighted(z.values(), 0.3, k.values());
      EXPECT_TRUE(sameBits(out.values(), expected)) << kernels->name << ", " << size;
      kernels->addWeighted(4 * z.pitch(), 0.3, k.data(), z.data());
      EXPECT_TRUE(sameBits(z.values(), expected)) << kernels->name << ", " << size;
    }
}

TEST(ChainKernels, DissipationHasTheBitsOfThePlainCode) {
  for (const ChainKernels* kernels : supportedChainKernels())
    for (const Eigen::Index size : kSizes) {
      const Chain chain = randomChain(size, SpringLaw{}, true, 9.81);
      const State state = randomState(size, 1);
      StateBuffer z(size);
      AlignedNumbers dissipated(z.pitch());
      z.values() = state.values();
      dissipated.view().setConstant(0.1);
      kernels->addDissipation(KernelConstants(chain).chain(), z.data(), 0.3, dissipated.data());
      for (Eigen::Index i = 0; i + 1 < size; ++i) {
        const State::Matrix& s = state.values();
        const auto rate = elongationRate<double>({s(i + 1, 0) - s(i, 0), s(i + 1, 1) - s(i, 1)},
                                                 {s(i + 1, 2) - s(i, 2), s(i + 1, 3) - s(i, 3)});
        EXPECT_EQ(dissipated[i], std::fma(0.3, rate * rate, 0.1)) << kernels->name << ", " << size;
      }
    }
}

TEST(ChainKernels, NamedInstructionSetLeavesOutFasterOnes) {
  const std::vector<const ChainKernels*>& all = supportedChainKernels();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<const ChainKernels*> found = chainKernelsUpTo(all[i]->name);
    EXPECT_EQ(found,
              std::vector<const ChainKernels*>(all.begin() + static_cast<long>(i), all.end()));
  }
  EXPECT_THROW(chainKernelsUpTo("sse9"), InputError);
}

TEST(ChainKernels, CompensatedSumKeepsWhatRoundingTakes) {
  for (const ChainKernels* kernels : supportedChainKernels())
    for (const Eigen::Index size : kSizes) {
      StateBuffer z(size), change(size), k(size), out(size), lost(size);
      z.values() = randomState(size, 1).values();
      change.values() = 1e-20 * randomState(size, 2).values();
      k.values() = randomState(size, 3).values();
      const SlopeSum terms{{{1e-9, k.data()}}, 1};
      kernels->compensatedSum(z.pitch(), z.data(), change.data(), terms, out.data(), lost.data());
      const State::Matrix step = plusWeighted(change.values(), 1e-9, k.values());
      const State::Matrix sum = z.values() + step;
      const State::Matrix difference = sum - z.values();
      const State::Matrix rest = step - difference;
      EXPECT_TRUE(sameBits(out.values(), sum)) << kernels->name << ", " << size;
      EXPECT_TRUE(sameBits(lost.values(), rest)) << kernels->name << ", " << size;
      EXPECT_GT(rest.cwiseAbs().maxCoeff(), 1e-19) << size;
    }
}

TEST(ChainKernels, LargestChangeFindsEveryPlaceAndRemembersWhatIsNotFinite) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const ChainKernels* kernels : supportedChainKernels())
    for (Eigen::Index place = 0; place < 4 * 11; ++place) {
      if (place % 11 == 0) continue;  // the fixed particle
      StateBuffer k(11);
      const auto set = [&](double value) { k.values()(place % 11, place / 11) = value; };
      const auto result = [&] {
        const SlopeSum sum{{{2.0, k.data()}}, 1};
        const LargestChange change = kernels->largestChange(11, k.pitch(), sum);
        EXPECT_EQ(place < 22 ? change.velocity : change.position, 0.0);
        return place < 22 ? change.position : change.velocity;
      };
      set(-1.5);
      EXPECT_EQ(result(), 3.0) << kernels->name;
      set(inf);
      EXPECT_FALSE(std::isfinite(result())) << kernels->name;
      set(std::nan(""));
      EXPECT_FALSE(std::isfinite(result())) << kernels->name;
    }
}

}  // namespace
}  // namespace spring_pendulum
