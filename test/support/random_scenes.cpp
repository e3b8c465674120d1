#include "support/random_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace spring_pendulum::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Random numbers. Unlike the standard distributions, they are the same with every library.
class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}

  double uniform(double least, double most) {
    return least + (most - least) * static_cast<double>(generator_()) / 4294967296.0;
  }
  double decades(double least, double most) { return std::pow(10.0, uniform(least, most)); }
  Eigen::Index whole(Eigen::Index least, Eigen::Index most) {
    return least + static_cast<Eigen::Index>(generator_() % (most - least + 1));
  }
  double pick(const std::vector<double>& values) { return values[generator_() % values.size()]; }

 private:
  std::mt19937 generator_;
};

/// A random scene; the default is a chain like that of the exercise.
struct Draft {
  Eigen::Index size() const { return masses.size(); }

  State start;
  Eigen::VectorXd masses;
  SpringLaw spring;
  double gravity = 9.81;
};

/// Springs of `least` to `most` m, each turned by up to `turn` rad against the one before.
State walk(Random& random, Eigen::Index size, double least, double most, double turn) {
  State state(size);
  double angle = random.uniform(-kPi, kPi);
  for (Eigen::Index i = 1; i < size; ++i) {
    angle += random.uniform(-turn, turn);
    const double length = random.uniform(least, most);
    state.x()[i] = state.x()[i - 1] + length * std::cos(angle);
    state.y()[i] = state.y()[i - 1] + length * std::sin(angle);
  }
  return state;
}

Draft chainOf(Random& random, Eigen::Index size, double turn = 1.2) {
  Draft draft;
  draft.start = walk(random, size, 0.9, 1.1, turn);
  draft.masses = Eigen::VectorXd::Constant(size, random.pick({0.3, 1.0, 2.0}));
  return draft;
}

struct Family {
  std::string name;
  std::function<Draft(Random&)> draw;
};

/// Draws a chain of `least` to `most` particles and changes it.
std::function<Draft(Random&)> with(int least, int most, double turn,
                                   const std::function<void(Random&, Draft&)>& change) {
  return [=](Random& r) {
    Draft d = chainOf(r, r.whole(least, most), turn);
    change(r, d);
    return d;
  };
}

std::function<Draft(Random&)> with(const std::function<void(Random&, Draft&)>& change) {
  return with(2, 12, 1.2, change);
}

/// Redraws the start with springs of nearly equal length, which is `least` to `most` m.
std::function<Draft(Random&)> withLengths(double least, double most) {
  return with([=](Random& r, Draft& d) {
    const double length = r.uniform(least, most);
    d.start = walk(r, d.size(), 0.9 * length, 1.1 * length, 1.2);
  });
}

std::vector<Family> shapes() {
  return {
      {"equal", with([](Random&, Draft&) {})},
      {"two particles", [](Random& r) { return chainOf(r, 2); }},
      {"long", [](Random& r) { return chainOf(r, r.whole(13, 60), 0.3); }},
      {"folded", with([](Random& r, Draft& d) {
         for (Eigen::Index i = 1; i < d.size(); ++i) {
           d.start.x()[i] = (i % 2 == 0 ? 0.0 : 1.0) + r.uniform(-0.1, 0.1);
           d.start.y()[i] = r.uniform(-0.1, 0.1);
         }
       })},
      {"curled", with([](Random& r, Draft& d) {
         const double radius = 1.0 / r.uniform(0.3, 1.5);
         for (Eigen::Index i = 1; i < d.size(); ++i) {
           const double angle = static_cast<double>(i) / radius;
           d.start.x()[i] = radius * std::sin(angle) + r.uniform(-0.01, 0.01);
           d.start.y()[i] = radius * (1.0 - std::cos(angle)) + r.uniform(-0.01, 0.01);
         }
       })},
      {"compressed", withLengths(0.2, 0.6)},
      {"stretched", withLengths(1.5, 3.0)},
      {"mixed lengths",
       with([](Random& r, Draft& d) { d.start = walk(r, d.size(), 0.1, 3.0, 1.2); })},
      {"vertical", with([](Random& r, Draft& d) {
         for (Eigen::Index i = 1; i < d.size(); ++i) {
           d.start.x()[i] = 0.0;
           d.start.y()[i] = d.start.y()[i - 1] - r.uniform(0.5, 2.0);
         }
       })},
      {"at rest", with([](Random& r, Draft& d) {
         d.start = hangingAtRest(Chain(d.masses, d.spring, d.gravity));
         for (Eigen::Index i = 1; i < d.size(); ++i)
           d.start.x()[i] += d.masses[0] > 1.0 ? 0.0 : r.uniform(-0.05, 0.05);
       })},
      {"standing", with([](Random& r, Draft& d) {
         for (Eigen::Index i = 1; i < d.size(); ++i) {
           d.start.x()[i] = d.start.x()[i - 1] + r.uniform(-0.2, 0.2);
           d.start.y()[i] = d.start.y()[i - 1] + r.uniform(0.8, 1.1);
         }
       })},
  };
}

std::vector<Family> springs() {
  return {
      {"undamped", with(2, 12, 0.5, [](Random&, Draft& d) { d.spring.damping = 0.0; })},
      {"weakly damped", with([](Random& r, Draft& d) { d.spring.damping = r.decades(-4, -1); })},
      {"overdamped", with([](Random& r, Draft& d) {
         d.spring.damping = r.pick({20.0, 200.0});
         d.masses.setConstant(0.1);
       })},
      {"stiff", with([](Random& r, Draft& d) {
         d.spring.stiffness = r.decades(3, 6);
         d.spring.damping = r.pick({1.0, 10.0, 100.0});
       })},
      {"very stiff", with(2, 5, 1.2,
                          [](Random& r, Draft& d) {
                            d.start = walk(r, d.size(), 0.99999, 1.00001, 1.2);
                            d.spring.stiffness = r.decades(6, 9);
                            d.spring.damping = r.decades(2, 5);
                          })},
      {"soft", with([](Random& r, Draft& d) { d.spring.stiffness = r.decades(-1, 1); })},
      {"no rest length", with([](Random&, Draft& d) { d.spring.rest_length = 0.0; })},
      {"weightless", with([](Random& r, Draft& d) {
         d.gravity = 0.0;
         d.start = walk(r, d.size(), 0.8, 1.4, 1.2);
       })},
      {"small springs", with([](Random& r, Draft& d) {
         d.spring.rest_length = 0.02;
         d.start = walk(r, d.size(), 0.018, 0.022, 1.2);
         d.masses.setConstant(0.1);
       })},
      {"strong gravity", with([](Random& r, Draft& d) { d.gravity = r.decades(1.5, 3); })},
  };
}

std::vector<Family> masses() {
  return {
      {"mixed masses", with([](Random& r, Draft& d) {
         const double decades = r.pick({1.0, 2.0, 3.0});
         for (Eigen::Index i = 0; i < d.masses.size(); ++i) d.masses[i] = r.decades(-decades, 0);
       })},
      {"light tail", with([](Random& r, Draft& d) { d.masses[d.size() - 1] = r.decades(-5, -2); })},
      {"very light tail",
       with(2, 6, 1.2, [](Random& r, Draft& d) { d.masses[d.size() - 1] = r.decades(-9, -5); })},
      {"light middle",
       with(3, 12, 1.2,
            [](Random& r, Draft& d) { d.masses[r.whole(1, d.size() - 2)] = r.decades(-5, -2); })},
      {"very light middle",
       with(3, 6, 1.2,
            [](Random& r, Draft& d) { d.masses[r.whole(1, d.size() - 2)] = r.decades(-9, -5); })},
      {"one light",
       [](Random& r) {
         Draft d = chainOf(r, 2);
         d.masses[1] = r.decades(-9, -3);
         return d;
       }},
      {"all light", with([](Random& r, Draft& d) { d.masses.setConstant(r.decades(-4, -1)); })},
      {"heavy end", with([](Random& r, Draft& d) {
         d.spring.stiffness = 500.0;
         d.masses[d.size() - 1] = r.pick({20.0, 50.0});
       })},
      {"undamped with a light tail", with(2, 6, 0.5,
                                          [](Random& r, Draft& d) {
                                            d.spring.damping = 0.0;
                                            d.masses[d.size() - 1] = r.decades(-5, -2);
                                          })},
  };
}

const std::vector<Family>& families() {
  static const std::vector<Family> kFamilies = [] {
    std::vector<Family> all = shapes();
    for (const auto& more : {springs(), masses()}) all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return kFamilies;
}

}  // namespace

Scene randomScene(unsigned seed) {
  const Family& family = families()[seed % families().size()];
  Random random(seed);
  const Draft draft = family.draw(random);
  return {fmt::format("{} {}", family.name, seed), Chain(draft.masses, draft.spring, draft.gravity),
          draft.start};
}

}  // namespace spring_pendulum::test
