// Held particles reach their targets and stay there, and bad inputs are told from good ones.
#include "ros/inputs/driver.hpp"

#include "ros/inputs/robots.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

struct Live {
  explicit Live(const Scenario& wanted = {})
      : run(makeScene(wanted, particles()), planOf(wanted), {true, 1.0 / 30.0, {}}) {
    run.advance();
  }

  static Plan planOf(Plan plan) {
    plan.frames = 10000;
    return plan;
  }
  static Scene particles() {
    const test::Scene scene = test::horizontalChain("horizontal", 6, 1.0);
    return {scene.chain.masses(), scene.start};
  }

  void go(double seconds) {
    const double end = run.time() + seconds;
    while (run.time() < end - 1e-9) {
      driver.apply(run, run.nextTime(), false);
      run.advancePart();
    }
  }

  Run run;
  int changes = 0;
  InputLog log{0.0, {}, [this](const PendulumInput&) { ++changes; }};
  Driver driver{run, &log};
};

TEST(Driver, BringAParticleToRestAtItsTarget) {
  Live live;
  live.go(0.1);
  EXPECT_FALSE(live.run.isChanged());
  live.driver.on(Hold{5, Target{{4.0, -2.0}, {}}});
  live.go(0.5);  // parts of 0.03 s and 0.04 s
  EXPECT_NEAR(live.run.state().x()[5], 4.0, 1e-3);
  EXPECT_NEAR(live.run.state().y()[5], -2.0, 1e-3);
  live.go(2.0);
  const int changes = live.changes;
  live.go(1.0);
  EXPECT_EQ(live.changes, changes);  // a particle at rest needs no changes
  EXPECT_NEAR(live.run.state().y()[5], -2.0, 1e-9);
  EXPECT_FALSE(isBad(live.run.verdict().kind)) << live.run.verdict().text;
}

TEST(Driver, BringAParticleBeyondThePositionsThatBoundedTheTolerance) {
  Scenario wanted;
  wanted.method = findMethod("Auto");
  wanted.tolerance = 4e-13;  // for a gravity of 9.8 m/s², that is, 9.8 m
  Live live(wanted);
  live.driver.on(Hold{5, Target{{12.0, 0.0}, {}}});
  live.go(2.0);
  EXPECT_NEAR(live.run.state().x()[5], 12.0, 1e-3);
}

TEST(Driver, ChangesEachConstantThatIsWanted) {
  Live live;
  live.driver.on(SetConstant{"tolerance", "1e-3"});  // not used yet
  live.go(0.1);
  EXPECT_FALSE(live.run.isChanged());
  for (const SetConstant& wanted : {SetConstant{"stiffness", "60"},
                                    {"damping", "0.5"},
                                    {"rest_length", "1.1"},
                                    {"gravity", "1.6"},
                                    {"air_drag", "0.1"},
                                    {"method", "Auto"},
                                    {"tolerance", "1e-9"}}) {
    const int before = live.changes;
    live.driver.on(wanted);
    live.go(0.1);
    EXPECT_EQ(live.changes, before + 1) << wanted.name;
  }
  EXPECT_EQ(live.run.plan().tolerance, 1e-9);
}

TEST(Driver, PlaceParticlesWhilePaused) {
  Live live;
  live.go(0.5);
  live.driver.on(Hold{3, Target{{1.0, 1.0}, {}}});
  live.driver.apply(live.run, live.run.nextTime(), true);
  EXPECT_EQ(live.run.state().x()[3], 1.0);
  EXPECT_EQ(live.run.state().vx()[3], 0.0);
  EXPECT_TRUE(live.run.chain().isHeld(3));
  live.driver.on(Release{3});
  live.go(0.5);
  EXPECT_FALSE(live.run.chain().isHeld(3));
  EXPECT_FALSE(isBad(live.run.verdict().kind)) << live.run.verdict().text;
}

TEST(Driver, GiveTheImpulseOfAForce) {
  Scenario weightless;
  weightless.constants = {{0.0, 0.0, 1.0}, 0.0};
  for (const double step : {0.01, 1e-10}) {
    weightless.time_step = step;
    Live live(weightless);
    live.driver.on(ApplyForceTo{4, {2.0, -1.0}, 5.0 * step, 56.0 * step});
    live.go(200.0 * step);
    EXPECT_NEAR(live.run.state().vx()[4], 2.0 * 56.0 * step, 1e-10 * step);
    EXPECT_NEAR(live.run.state().vy()[4], -1.0 * 56.0 * step, 1e-10 * step);
  }
}

TEST(Driver, ComeToRestUnderTheForcesThatLast) {
  Live live;
  live.driver.on(ApplyForceTo{4, {30.0, 0.0}, 0.0, 0.003});
  EXPECT_EQ(live.driver.on(ComeToRest{}),
            "the chain hangs at rest from the next state on, until a force begins or ends");
  live.driver.apply(live.run, live.run.nextTime(), false);
  EXPECT_NEAR(live.run.state().x()[4], 0.0, 1e-12);
}

TEST(Driver, BringAParticleSmoothlyIfIntervalsAreShort) {
  Live live;
  Driver driver(live.run, nullptr, 0.2);
  driver.on(Hold{0, Target{{0.001, 0.0}, {}, {}}});
  while (live.run.time() < 4.0) {
    driver.apply(live.run, live.run.nextTime(), false);
    for (const HeldParticle& held : live.run.chain().drive().held)
      EXPECT_LT(std::abs(held.acceleration.x), 0.03);  // 0.9 m/s² within two intervals
    live.run.advancePart();
  }
  EXPECT_NEAR(live.run.state().x()[0], 0.001, 1e-8);
}

TEST(Driver, SwitchBetweenStepControlsAtAFrame) {
  Live live;
  live.driver.on(SetConstant{"method", "Auto"});
  live.run.advancePart();
  ASSERT_FALSE(live.run.isAtFrame());
  live.go(1.0);
  EXPECT_EQ(live.run.plan().method.get().name, "Auto");
  live.driver.on(SetConstant{"method", "Euler"});
  live.run.advancePart();
  live.driver.reset(live.run);
  EXPECT_EQ(live.run.plan().method.get().name, "Euler");  // from the start on
  EXPECT_FALSE(live.run.isChanged());
  EXPECT_EQ(live.run.time(), 0.0);
  EXPECT_EQ(live.run.state().values(), live.run.start().values());
}

TEST(Follower, RefusesJumpsReversedTimeAndNumbersThatAreNot) {
  std::string said;
  Follower follower("odom", 1.0, [&said](const std::string& text) { said = text; });
  const auto takes = [&](double x, double stamp, double now) {
    return follower.take({x, 0.0}, stamp, now);
  };
  const std::string held = ": such inputs are ignored until they are steady";
  EXPECT_FALSE(follower.targetAt(0.0, {}, 0.03).has_value());
  EXPECT_TRUE(takes(0.0, 1.0, 1.0));
  EXPECT_TRUE(takes(0.5, 1.1, 1.1));
  EXPECT_EQ(std::exchange(said, ""), "");
  EXPECT_FALSE(takes(5.0, 1.2, 1.2));
  EXPECT_EQ(std::exchange(said, ""),
            "odom jumps by more than 1 m (check its frame and unit)" + held);
  EXPECT_FALSE(takes(std::nan(""), 1.3, 1.3));
  EXPECT_EQ(std::exchange(said, ""), "");  // said once
  EXPECT_TRUE(takes(0.6, 1.4, 1.4));       // a single jump is forgotten
  EXPECT_TRUE(takes(0.6, 1.8, 1.81));
  EXPECT_EQ(std::exchange(said, ""), "odom is followed again");
  EXPECT_FALSE(takes(0.6, 1.0, 2.0));
  EXPECT_EQ(std::exchange(said, ""), "odom runs backwards in time" + held);
  EXPECT_TRUE(takes(0.6, 1.1, 2.1));  // its clock has started again
  EXPECT_EQ(std::exchange(said, ""), "");
  EXPECT_FALSE(follower.isSilent(2.2));
  EXPECT_TRUE(follower.isSilent(2.9) && follower.targetAt(2.9, {}, 0.03).has_value());
  EXPECT_EQ(std::exchange(said, ""), "odom has stopped: the particle is held where it is");
  EXPECT_TRUE(takes(0.6, 3.0, 3.0));
  EXPECT_EQ(std::exchange(said, ""), "odom is followed again");
  EXPECT_TRUE(follower.isSilent(4.0));
  EXPECT_EQ(follower.targetAt(4.0, {}, 0.03)->velocity.x, 0.0);
  EXPECT_EQ(std::exchange(said, ""), "odom has stopped: the particle is held where it is");
  EXPECT_FALSE(takes(std::nan(""), 4.1, 4.1));
  EXPECT_EQ(std::exchange(said, ""), "odom has numbers that are not finite" + held);
  EXPECT_TRUE(takes(5.0, 0.0, 4.2));  // after a silence, any place is a start
}

TEST(Follower, StandsWhereTheSameMessageComesAgain) {
  Follower follower("in", 3.0, [](auto&) {});
  for (double now = 1.0; now < 4.0; now += 0.03) {
    const double stamp = std::min(now, 2.0), place = 0.8 * stamp;
    EXPECT_TRUE(follower.take({place, 0.0}, stamp, now));
    const double x = follower.targetAt(now, {}, 0.03)->position.x;
    EXPECT_TRUE(now < 2.2 || x == place) << now;
  }
}

TEST(Follower, SaysOnceThatInputsContradictEachOther) {
  for (const double other : {25.0, std::nan("")}) {
    int said = 0;
    Follower follower("pose", 2.5, [&said](const std::string&) { ++said; });
    for (int i = 0; i < 340; ++i) {
      EXPECT_TRUE(i != 300 || said == 1) << said;
      const bool is_other = i % 2 == 1 && i < 300;
      EXPECT_NE(follower.take({is_other ? other : 5.0, 0.0}, i / 60.0, 1.0 + i / 60.0), is_other);
    }
    EXPECT_EQ(said, 2);  // followed again
  }
}

TEST(Follower, SaysNothingOfAnApproachThatEndedInAPause) {
  std::string said;
  Follower follower("pose", 9.0, [&said](const std::string& text) { said = text; });
  for (double t = 0.0; t < 9.0; t += 0.1) {
    follower.take({2.0 + t, 0.0}, t, t);
    follower.targetAt(t, {}, t < 1.0 ? 0.1 : 0.0);
  }
  follower.targetAt(9.0, {10.8, 0.0}, 0.1);
  EXPECT_EQ(said, "pose: the particle comes to it from 2 m away");
}

// After any inputs, a steady one is followed within a second.
TEST(Follower, FollowsASteadyInputAgain) {
  std::mt19937 random(4);
  const auto draw = [&random](double size) {
    return size * (static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 0.5);
  };
  for (int round = 0; round < 200; ++round) {
    Follower follower("odom", 1.0, [](auto&) {});
    double now = 1.0;
    for (int i = 0; i < 20; ++i, now += 0.03)
      follower.take({draw(20.0), draw(20.0)}, draw(100.0), now);
    bool follows = false;
    const double stamp = draw(100.0), start = now, moves = 0.1 * (round % 2);  // or the same again
    for (; now < start + 1.0; now += 0.03)
      follows = follower.take({3.0, moves * (now - start)}, stamp + moves * now, now);
    EXPECT_TRUE(follows && !follower.isSilent(now)) << round;
    EXPECT_NEAR(follower.targetAt(now, {3.0, 0.1}, 0.03)->position.x, 3.0, 1e-9) << round;
  }
}

struct Inputs {
  double rate;          ///< 1/s
  double clock = 1.0;   ///< of the stamps, seconds per second
  double jitter = 0.0;  ///< s, of the time on the way
  double end = 8.0;     ///< s
  int bundle = 1;       ///< inputs that come at once
  int copies = 1;       ///< of each input, on the way to the next one
  int set = 30;         ///< s, by which the clock goes ahead at 5 s
};

/// The tip of a chain follows a holder with a position at each time.
template <typename Holder, typename Check>
void follow(const Holder& holder_at, const Inputs& inputs, const Check& check) {
  Live live;
  Follower follower("odom", 3.0, [](auto&) {});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> delay(0.0, inputs.jitter);
  const auto time_of = [&](int input) { return input / inputs.rate; };
  double delayed = 0.0;
  for (int next = 0; live.run.time() < 8.0;) {
    const double now = live.run.nextTime();  // the state that is computed is shown now
    for (; time_of(next) < inputs.end; ++next, delayed = delay(random)) {
      const int last = next - next % inputs.bundle + inputs.bundle - 1;
      if (time_of(last) + delayed > now) break;
      for (int i = 0; i < inputs.copies; ++i)  // the clock is set after the first input, too
        follower.take(
            holder_at(time_of(next)),
            inputs.clock * (time_of(next) + 990 * (next > 0) + inputs.set * (time_of(next) > 5)),
            time_of(last) + delayed + i / inputs.rate / inputs.copies);
    }
    const State& state = live.run.state();
    const auto target = follower.targetAt(now, {state.x()[5], state.y()[5]}, now - live.run.time());
    if (target) live.driver.on(Hold{5, *target});
    live.driver.apply(live.run, now, false);
    live.run.advancePart();
    const PlaneVector<double> to = holder_at(live.run.time());
    check(live.run, std::hypot(live.run.state().x()[5] - to.x, live.run.state().y()[5] - to.y));
  }
}

TEST(Follower, IsWithItsHolderOnACircle) {
  constexpr double kSpeed = 2.1;  // m/s, faster than a particle comes to its holder
  const auto holder_at = [](double t) {
    return PlaneVector<double>{4.0 + std::cos(kSpeed * t), -1.0 + std::sin(kSpeed * t)};
  };
  const auto largest_distance = [&](const Inputs& inputs) {
    double largest = 0.0;
    follow(holder_at, inputs, [&](const auto& run, double distance) {
      if (run.time() > 4.0) largest = std::max(largest, distance);
      const double speed = std::hypot(run.state().vx()[5], run.state().vy()[5]);
      EXPECT_TRUE(inputs.jitter > 0.0 || run.time() < 0.4 || speed < kSpeed + 1.11) << speed;
    });
    return largest;
  };
  for (const double clock : {0.0, 0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0, 20.0})  // slower: 0.03 s
    EXPECT_LT(largest_distance({30.0, clock}), clock > 0 && clock < 1 ? 0.07 : 2e-3);
  EXPECT_LT(largest_distance({30.0, 1.0, 0.0, 8.0, 1, 1, -10}), 3e-3);
  EXPECT_EQ(largest_distance({8.0, 1.0, 0.0, 8.0, 1, 5}), largest_distance({8.0}));
  EXPECT_LT(largest_distance({30.0, 1.0, 0.01}), 5e-3);
  for (const double clock : {0.9, 1.0, 2.0})
    for (const int bundle : {2, 5, 10})
      EXPECT_LT(largest_distance({100.0, clock, 0.0, 8.0, bundle}), clock < 1.0 ? 0.05 : 3.1e-3);
}

TEST(Follower, ComesSlowlyAfterAStepOfItsHolder) {
  for (const double rate : {5.0, 10.0, 30.0, 100.0, 500.0})
    for (const double step : {-2.8, -1.5, -0.3}) {
      const auto place = [=](double t) {  // the very first input is elsewhere
        return PlaneVector<double>{t == 0.0 ? 3.0 : t < 2.0 ? 5.0 : 5.0 + step, 0.0};
      };
      for (const Inputs& inputs : {Inputs{rate}, {rate, 1.0, 0.0, 2.0 + 1.5 / rate}}) {
        follow(place, inputs, [&](const auto& run, double distance) {
          const double speed = std::hypot(run.state().vx()[5], run.state().vy()[5]);
          EXPECT_LT(speed, run.time() < 1.5 ? 2.1 : 1.6) << rate << " " << step;
          const bool has_come = distance < 1e-3 || run.time() < 6.0 || inputs.end < 8.0;
          EXPECT_TRUE(has_come) << rate << " " << step << " " << distance;
        });
      }
      const auto two = [=](double t) {  // publishers in turn
        return PlaneVector<double>{5.0 + step * static_cast<double>(std::lround(t * rate) % 2),
                                   0.0};
      };
      follow(two, {rate}, [](const auto& run, double /*distance*/) {
        EXPECT_LT(std::abs(run.state().vx()[5]), 3.2) << run.time();
      });
    }
}

TEST(Follower, ComesBackSlowlyAfterASilence) {
  std::string said;
  Follower follower("odom", 1e20, [&said](const std::string& text) { said = text; });
  for (double t = 0.0; t < 1.0; t += 0.03) follower.take({0.0, 0.0}, t, t);
  EXPECT_LT(std::hypot(follower.targetAt(1.0, {0.0, 0.0}, 0.03)->position.x, 0.0), 1e-12);
  follower.take({4.0, 0.0}, 3.0, 3.0);
  EXPECT_EQ(follower.targetAt(3.0, {0.0, 0.0}, 0.03)->fastest, 1.0);
  EXPECT_EQ(said, "odom: the particle comes to it from 4 m away");
  follower.take({1e17, 0.0}, 3.1, 3.1);
  EXPECT_EQ(follower.targetAt(3.1, {0.0, 0.0}, 0.03)->fastest, 1.0);
  for (const double x : {0.5, 0.6})  // silent before the particle has come to it: it stays
    EXPECT_EQ(follower.targetAt(3.6, {x, 0.0}, 0.03)->position.x, 0.5);
}

TEST(Follower, DoesNotExtrapolateOverALongInterval) {
  Follower follower("odom", 9.0, [](auto&) {});
  for (double t = 0.0; t < 1.0; t += 0.03)
    follower.take({std::cos(2.0 * t), std::sin(2.0 * t)}, t, t);
  const PlaneVector<double> target = follower.targetAt(1.0, {}, 2.0)->position;
  EXPECT_NEAR(std::hypot(target.x, target.y), 1.0, 0.01);
}

TEST(Robots, ParseHeldParticles) {
  using List = std::vector<HolderFrame>;
  EXPECT_EQ(parseHeld("", 5), List{});
  EXPECT_EQ(parseHeld("1, last=gripper", 5), (List{{0, ""}, {4, "gripper"}}));
  EXPECT_EQ(parseHeld("3 2", 5), (List{{1, ""}, {2, ""}}));
  for (const char* wrong : {"0", "6", "1.5", "x", "1,1", "last 5", "=a", "x=a"})
    EXPECT_THROW(parseHeld(wrong, 5), InputError) << wrong;
}

}  // namespace
}  // namespace spring_pendulum
