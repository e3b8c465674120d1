// The border between the library and the page: plain JavaScript values in, numbers and texts out.
//
// The worker (worker.js) calls these functions. Runs read and write files as Exercise3 does; the files
// are in memory. What Exercise3 prints to standard error goes to standard error here, too.
#include "check/checker.hpp"
#include "integration/tableau.hpp"
#include "io/program/program.hpp"
#include "simulation/advice/linear_stability.hpp"
#include <spring_pendulum/spring_pendulum.hpp>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <cstdint>
#include <emscripten/bind.h>
#include <emscripten/val.h>
#include <exception>
#include <string>
#include <vector>

namespace spring_pendulum {
namespace {

using emscripten::typed_memory_view;
using emscripten::val;

/// Returns a Float64Array of its own.
val numbers(const std::vector<double>& values) {
  return val(typed_memory_view(values.size(), values.data())).call<val>("slice");
}

std::string textOf(const val& value) {
  return val::global("String")(value).as<std::string>();
}

/// \param settings an object whose keys are options of Exercise3, with underscores
Scenario scenarioOf(const val& settings) {
  std::vector<std::pair<std::string, std::string>> options;
  const auto keys =
      emscripten::vecFromJSArray<std::string>(val::global("Object").call<val>("keys", settings));
  for (const std::string& key : keys) options.emplace_back(key, textOf(settings[key]));
  return makeScenario(options);
}

val describeMethod(const Method& method) {
  val row = val::object();
  row.set("name", method.name);
  row.set("order", method.order);
  row.set("fixed", method.hasFixedStep());
  row.set("symplectic", method.symplectic);
  row.set("realLimit", method.real_stability_limit);
  row.set("imaginaryLimit", method.imaginary_stability_limit);
  row.set("use", method.use);
  if (method.tableau == nullptr) return row;
  const ButcherTableau& tableau = *method.tableau;
  val a = val::array();
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    a.call<void>("push", numbers({tableau.a[i].begin(), tableau.a[i].begin() + tableau.stages}));
  }
  row.set("a", a);
  row.set("b", numbers({tableau.b.begin(), tableau.b.begin() + tableau.stages}));
  return row;
}

val methods() {
  val rows = val::array();
  for (const Method& method : methodTable()) rows.call<void>("push", describeMethod(method));
  return rows;
}

/// The options of Exercise3 with their defaults, as in its help text.
val optionRows() {
  val rows = val::array();
  Scenario defaults;
  for (const Option& option : scenarioOptions(defaults)) {
    val row = val::object();
    row.set("key", std::string(option.key));
    row.set("unit", std::string(option.unit));
    row.set("meaning", std::string(option.meaning));
    row.set("value", option.text());
    rows.call<void>("push", row);
  }
  return rows;
}

/// Returns the columns x, y, m, vx and vy of a particle file.
val columnsOfScene(const val& settings) {
  const Scene particles = readScene(scenarioOf(settings));
  const auto column = [](const auto& values) {
    return numbers({values.data(), values.data() + values.size()});
  };
  val scene = val::object();
  scene.set("x", column(particles.state.x()));
  scene.set("y", column(particles.state.y()));
  scene.set("m", column(particles.masses));
  scene.set("vx", column(particles.state.vx()));
  scene.set("vy", column(particles.state.vy()));
  return scene;
}

State stateOf(const val& values) {
  const auto list = emscripten::convertJSArrayToNumberVector<double>(values);
  State state(static_cast<std::ptrdiff_t>(list.size() / 4));
  std::copy_n(list.begin(), state.size() * 4, state.values().data());
  return state;
}

Chain chainOf(const Scenario& scenario, const val& masses) {
  const auto list = emscripten::convertJSArrayToNumberVector<double>(masses);
  const auto size = static_cast<std::ptrdiff_t>(list.size());
  return Chain(Eigen::Map<const Eigen::VectorXd>(list.data(), size), scenario.constants);
}

/// A run that JavaScript advances piece by piece. Between the frames it stops every
/// `display_interval` s, for a smooth picture.
class LabRun {
 public:
  /// \param tick called about every 20 ms with the number of the last frame
  LabRun(const val& settings, double display_interval, bool energies, const val& tick)
      : LabRun(scenarioOf(settings), display_interval, energies, tick) {}
  LabRun(const Scenario& scenario, double display_interval, bool energies, const val& tick)
      : run_(readScene(scenario), scenario,
             {energies || !scenario.energy.empty(), display_interval,
              [this, tick] {
                tick(static_cast<double>(run_.frame()));
                return false;
              }}),
        files_(run_, scenario) {
    printError(startLines(run_));
  }

  /// Advances until `bytes` are sampled, or for about as many ms as given. Returns the samples, or
  /// nothing once the run is over.
  val advance(double milliseconds, double bytes) {
    times_.clear();
    states_.clear();
    truths_.clear();
    const double end = now() + milliseconds;
    bool more = true;
    do {
      more = run_.advancePart();
      if (more) sample();
    } while (more && now() < end && 8.0 * static_cast<double>(states_.size()) < bytes);
    if (times_.empty()) return val::null();
    val samples = val::object();
    samples.set("rows", numbers(times_));
    samples.set("states", numbers(states_));
    samples.set("truths", numbers(truths_));
    return samples;
  }

  /// Ends the run as Exercise3 does and returns what it says about itself.
  val finish() {
    files_.finish();
    val end = val::object();
    end.set("output", run_.closingLine());
    end.set("status", conclude(run_));
    const Verdict& verdict = run_.verdict();
    end.set("kind", std::string(toString(verdict.kind)));
    end.set("bad", isBad(verdict.kind));
    end.set("text", verdict.text);
    end.set("time", verdict.time);
    end.set("particle", static_cast<double>(verdict.particle));
    const PositionError error = run_.positionError();
    end.set("largest", error.largest);
    end.set("largestTime", error.largest_time);
    end.set("bound", error.bound);
    end.set("resolved", error.isResolved());
    end.set("measuredUntil", error.measured_until);
    end.set("energyError", run_.largestEnergyError());
    end.set("evaluations", static_cast<double>(run_.integrator().forceEvaluations()));
    end.set("report", run_.integrator().report());
    end.set("measurements", run_.measurements());
    return end;
  }

 private:
  static double now() { return val::global("performance").call<double>("now"); }

  void sample() {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (run_.isAtFrame()) files_.write(run_);
    const EnergyEntry entry = run_.energyEntry();
    const PositionError error = run_.positionError();
    times_.insert(times_.end(),
                  {run_.time(), run_.isAtFrame() ? static_cast<double>(run_.frame()) : -1.0,
                   error.now, entry.energy.kinetic, entry.energy.gravity, entry.energy.spring,
                   entry.dissipated.value_or(kNone), entry.relative_residual.value_or(kNone)});
    append(states_, run_.state(), 4);
    // A sample has 2 N numbers of the true motion if it is known, or none.
    if (const State* truth = run_.referenceState()) append(truths_, *truth, 2);
  }

  static void append(std::vector<double>& list, const State& state, std::ptrdiff_t columns) {
    const double* const begin = state.values().data();
    list.insert(list.end(), begin, begin + columns * state.size());
  }

  Run run_;
  RunFiles files_;
  std::vector<double> times_, states_, truths_;
};

/// Returns the largest stable step size in s; 0: none, infinite: any.
double stableStep(const val& settings) {
  const Scenario scenario = scenarioOf(settings);
  const Scene scene = readScene(scenario);
  return largestStableStep(scene.chain(), scene.state, scenario).step;
}

ButcherTableau tableauOf(const val& rows, const val& b) {
  ButcherTableau tableau;
  tableau.stages = b["length"].as<std::size_t>();
  if (tableau.stages < 1 || tableau.stages > ButcherTableau::kMaxStages) {
    throw InputError("the tableau must have 1 to " + std::to_string(ButcherTableau::kMaxStages) +
                     " stages");
  }
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    for (std::size_t j = 0; j < tableau.stages; ++j) tableau.a[i][j] = rows[i][j].as<double>();
    tableau.b[i] = b[i].as<double>();
  }
  return tableau;
}

/// Returns ln |R| at points of the complex plane.
/// \param method its name, or an object with a tableau a, b
/// \param points real and imaginary part of each
val growthAt(const val& method, const val& points) {
  ButcherTableau tableau;
  Method own;
  if (!method.isString()) {
    tableau = tableauOf(method["a"], method["b"]);
    own.tableau = &tableau;
  }
  const Method& row = method.isString() ? findMethod(method.as<std::string>()) : own;
  const auto parts = emscripten::convertJSArrayToNumberVector<double>(points);
  std::vector<double> values;
  for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
    values.push_back(growthPerStep(row, std::hypot(parts[i], parts[i + 1]), -2.0 * parts[i]));
  }
  return numbers(values);
}

/// Returns real and imaginary parts of the eigenvalues in 1/s of the motion at a state, from its
/// numerical Jacobian without the first particle, which is fixed.
val eigenvaluesAt(const val& settings, const val& masses, const val& values) {
  constexpr double kStep = 1e-5;  // m and m/s
  const Chain chain = chainOf(scenarioOf(settings), masses);
  const State state = stateOf(values);
  const Eigen::Index moving = state.size() - 1;
  Eigen::MatrixXd jacobian(4 * moving, 4 * moving);
  for (Eigen::Index j = 0; j < 4 * moving; ++j) {
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(moving, 4);
    for (const double step : {-kStep, kStep}) {
      State disturbed = state, slope;
      disturbed.values()(1 + j % moving, j / moving) += step;
      computeSlope(chain, disturbed, slope);
      change += slope.values().bottomRows(moving) / (2.0 * step);
    }
    jacobian.col(j) = Eigen::Map<const Eigen::VectorXd>(change.data(), 4 * moving);
  }
  if (moving == 0) return numbers({});
  const Eigen::VectorXcd found = jacobian.eigenvalues();
  const auto* parts = reinterpret_cast<const double*>(found.data());
  return numbers({parts, parts + 2 * found.size()});
}

/// Returns the states of all stages of one step of a tableau, of Velocity-Verlet or of Backward-Euler, their
/// slopes, and the state after the step, each N×4 by columns. Other methods have one stage, the start.
val explainStep(const val& settings, const val& masses, const val& values, double time_step) {
  const Scenario scenario = scenarioOf(settings);
  const Method& method = scenario.method;
  const Chain chain = chainOf(scenario, masses);
  const State start = stateOf(values);
  const auto flat = [](const State& state) {
    return numbers({state.values().data(), state.values().data() + 4 * state.size()});
  };
  val stages = val::array();
  val slopes = val::array();
  const bool verlet = method.name == "Velocity-Verlet";
  const bool implicit = method.name == "Backward-Euler";
  State end = start;
  makeIntegrator(method, chain, {scenario.tolerance})->advance(end, time_step, 1);
  std::vector<State> k(method.tableau != nullptr ? method.tableau->stages
                                                 : 1 + (verlet || implicit));
  for (std::size_t i = 0; i < k.size(); ++i) {
    State stage = implicit && i == 1 ? end : start;
    for (std::size_t j = 0; j < i && !implicit; ++j) {
      stage.values() += time_step * (verlet ? 1.0 : method.tableau->a[i][j]) * k[j].values();
    }
    if (verlet && i == 1) {  // new positions
      stage.values().leftCols(2) += 0.5 * time_step * time_step * k[0].values().rightCols(2);
    }
    computeSlope(chain, stage, k[i]);
    stages.call<void>("push", flat(stage));
    slopes.call<void>("push", flat(k[i]));
  }
  val step = val::object();
  step.set("stages", stages);
  step.set("slopes", slopes);
  step.set("end", flat(end));
  return step;
}

/// A tree as the array of its root's subtrees.
val nested(const Tree& tree) {
  val branches = val::array();
  for (const Tree& branch : tree.branches) branches.call<void>("push", nested(branch));
  return branches;
}

/// Returns the order conditions up to order 5 of a tableau: order, tree, left and right side.
val orderConditions(const val& a, const val& b) {
  const ButcherTableau tableau = tableauOf(a, b);
  val rows = val::array();
  for (const Tree& tree : rootedTrees(5)) {
    const std::vector<double> weights = elementaryWeights(tableau, tree);
    double sum = 0.0;
    for (std::size_t i = 0; i < tableau.stages; ++i) sum += tableau.b[i] * weights[i];
    val row = val::object();
    row.set("order", tree.order);
    row.set("tree", nested(tree));
    row.set("left", sum);
    row.set("density", tree.density());
    rows.call<void>("push", row);
  }
  return rows;
}

void addMethod(const std::string& name, const val& a, const val& b) {
  const ButcherTableau tableau = tableauOf(a, b);
  Method method = methodOfTableau(name, tableau);
  method.use = "your own tableau";
  registerMethod(method);
}

/// Compares frames with what they should be. What is in `settings` is given, the rest is the default.
/// \param indices, names, texts of the frames
val checkFrameTexts(const val& settings, bool method_is_given, const val& indices, const val& names,
                    const val& texts, const val& stop) {
  const Scenario scenario = scenarioOf(settings);
  std::vector<FrameText> frames;
  for (std::size_t i = 0; i < texts["length"].as<std::size_t>(); ++i) {
    frames.push_back({static_cast<std::int64_t>(indices[i].as<double>()),
                      names[i].as<std::string>(), texts[i].as<std::string>()});
  }
  const FrameCheck check = checkFrames(scenario, readScene(scenario), frames, method_is_given,
                                       [stop] { return stop().as<bool>(); });
  val result = val::object();
  result.set("report", val::array(check.lines));
  if (check.departure_time) result.set("time", *check.departure_time);
  return result;
}

/// Returns the message and the exit status that Exercise3 would have for a C++ exception.
val failureAt(std::uintptr_t address) {
  const Failure failure = failureOf(*reinterpret_cast<std::exception*>(address));
  val result = val::object();
  result.set("message", failure.message);
  result.set("status", static_cast<int>(failure.status));
  return result;
}

}  // namespace
}  // namespace spring_pendulum

EMSCRIPTEN_BINDINGS(lab) {
  namespace lab = spring_pendulum;
  emscripten::function("methods", &lab::methods);
  emscripten::function("options", &lab::optionRows);
  emscripten::function("readScene", &lab::columnsOfScene);
  emscripten::function("stableStep", &lab::stableStep);
  emscripten::function("growthAt", &lab::growthAt);
  emscripten::function("eigenvalues", &lab::eigenvaluesAt);
  emscripten::function("explainStep", &lab::explainStep);
  emscripten::function("orderConditions", &lab::orderConditions);
  emscripten::function("addMethod", &lab::addMethod);
  emscripten::function("checkFrames", &lab::checkFrameTexts);
  emscripten::function("failureAt", &lab::failureAt);
  emscripten::class_<lab::LabRun>("LabRun")
      .constructor<lab::val, double, bool, lab::val>()
      .function("advance", &lab::LabRun::advance)
      .function("finish", &lab::LabRun::finish);
}
