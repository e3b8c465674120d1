// simulate, check and the table of options.
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/simulation/outcome.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <pybind11/stl.h>
#include <utility>
#include <vector>

#include "binding.hpp"

namespace spring_pendulum::python {
namespace {

using namespace py::literals;

constexpr py::ssize_t kFrameNumbers = 9;  ///< as `recordNumbers` writes them

/// Unlike a program, Python writes frame files only if asked.
Scenario pythonDefaults() {
  Scenario scenario;
  scenario.output.clear();
  return scenario;
}

bool isPath(const py::object& value) {
  // Not py::str, which includes bytes before version 2.7 of pybind11.
  return PyUnicode_Check(value.ptr()) || py::hasattr(value, "__fspath__");
}

/// Encodes a name as the file system does.
std::string textOf(const py::object& value, std::string_view key, std::string_view range) {
  PyObject* bytes = nullptr;
  if (isPath(value) && PyUnicode_FSConverter(value.ptr(), &bytes) != 0)
    return py::reinterpret_steal<py::bytes>(bytes);
  PyErr_Clear();  // a null character, for example
  throw InputError(fmt::format("{}: must be {}, got {}", key, range, reprOf(value)));
}

/// The text of a value as the option table reads it.
std::string optionText(const Option& option, const py::object& value) {
  if (option.isText()) return textOf(value, option.key, option.range());
  py::detail::make_caster<bool> flag;
  if (flag.load(value, false)) return flag ? "true" : "false";
  if (PyObject* index = PyNumber_Index(value.ptr()))
    return reprOf(py::reinterpret_steal<py::object>(index));
  PyErr_Clear();
  const double number = PyFloat_AsDouble(value.ptr());  // does not parse text
  if (PyErr_Occurred() == nullptr) return py::repr(py::float_(number));
  PyErr_Clear();
  return reprOf(value);
}

Scenario scenarioOf(const py::dict& options) {
  Scenario scenario = pythonDefaults();
  const std::vector<Option> known = scenarioOptions(scenario);
  std::vector<std::pair<std::string, std::string>> given;
  for (const auto& [key, value] : options) {
    const auto name = key.cast<std::string>();
    std::string text;
    for (const Option& option : known)
      if (option.key == name) text = optionText(option, py::reinterpret_borrow<py::object>(value));
    given.emplace_back(name, text);
  }
  return makeScenario(given, scenario);
}

/// Writes an array of shape (N, 3) as the text of a particle file, so that its rules apply.
std::string particleText(const Numbers& rows) {
  std::string text;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    for (py::ssize_t j = 0; j < rows.shape(1); ++j) text += fmt::format("{} ", *rows.data(i, j));
    text += '\n';
  }
  return text;
}

/// \param particles a path or an array; sets `scenario.particles`
Scene sceneOf(const py::object& particles, Scenario& scenario) {
  const bool is_path = isPath(particles);
  scenario.particles = is_path ? textOf(particles, "particles", "a path") : "";
  if (is_path) return readScene(scenario);
  if (scenario.resume) throw InputError("resume: needs a file of save_state, not an array");
  return makeScene(scenario,
                   parseParticles(particleText(toNumbers(particles, "particles", 2)), "particles"));
}

/// Writes the numbers of a frame into a column of a table with a row for each quantity.
void recordNumbers(const Run& run, double* column, py::ssize_t frames) {
  const EnergyEntry entry = run.energyEntry();
  for (const double number :
       {entry.time, entry.energy.kinetic, entry.energy.gravity, entry.energy.spring,
        entry.energy.total(), entry.dissipated.value_or(NAN), entry.residual.value_or(NAN),
        entry.relative_residual.value_or(NAN), run.positionError().now}) {
    *column = number;
    column += frames;
  }
}

py::tuple tupleOf(const Verdict& verdict) {
  return py::make_tuple(std::string(toString(verdict.kind)), verdict.text, verdict.time);
}

py::dict simulate(const py::object& particles, const py::dict& options) {
  Scenario scenario = scenarioOf(options);
  const Scene scene = sceneOf(particles, scenario);
  Interruption interruption;
  Run run(scene, scenario, {true, 0.0, [&] { return interruption(); }});
  const py::ssize_t frames = scenario.frames - scene.frame;
  const py::ssize_t state_size = run.state().values().size();
  // NumPy would call it a wrong value.
  if (frames > PY_SSIZE_T_MAX / 8 / std::max(state_size, kFrameNumbers)) throw std::bad_alloc();
  py::array_t<double> numbers({kFrameNumbers, frames});
  py::array_t<double> states({frames, py::ssize_t{4}, state_size / 4});
  double* const number = numbers.mutable_data();
  double* const state = states.mutable_data();
  py::ssize_t count = 0;
  RunFiles output(run, scenario);
  std::vector<std::string> warnings;
  {
    const Computation computation;
    if (const auto warning = remarksOn(run).warning; !warning.empty()) warnings.push_back(warning);
    while (run.advance()) {
      std::copy_n(run.state().values().data(), state_size, state + count * state_size);
      recordNumbers(run, number + count++, frames);
      output.write(run);
    }
    output.finish();
    if (!run.wasStopped()) {
      const Outcome outcome = outcomeOf(run, [&] { return interruption(); });
      warnings.insert(warnings.end(), outcome.lines.begin(), outcome.lines.end());
    }
  }
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return py::dict("states"_a = states[py::slice(0, count, 1)], "seconds"_a = run.seconds(),
                  "numbers"_a = numbers[py::make_tuple(py::ellipsis(), py::slice(0, count, 1))],
                  "chain"_a = run.chain(), "method"_a = scenario.method.get().name,
                  "verdict"_a = tupleOf(run.verdict()), "warnings"_a = warnings,
                  "force_evaluations"_a = run.integrator().forceEvaluations(),
                  "closing_line"_a = py::reinterpret_steal<py::str>(PyUnicode_DecodeFSDefault(
                      run.closingLine(output.closingText()).c_str())));  // has the path
}

py::tuple check(const py::object& particles, const py::dict& options) {
  Scenario scenario = scenarioOf(options);
  const Scene scene = sceneOf(particles, scenario);
  Interruption interruption;
  const StabilityReport report = [&] {
    const Computation computation;
    return checkStability(scene.chain(), scene.state, scenario.from(scene.frame),
                          [&] { return interruption(); });
  }();
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return py::make_tuple(report.text, report.verdict ? tupleOf(*report.verdict) : py::tuple(),
                        report.position_error, report.stable.step, report.accurate_step);
}

}  // namespace

void defineSimulation(py::module_& module) {
  module.def("simulate", &simulate);  // the parts of a Run
  module.def("check", &check);        // the parts of a Report
  module.def("options", [] {
    py::list rows;
    Scenario defaults = pythonDefaults();
    for (const Option& option : scenarioOptions(defaults))
      rows.append(py::make_tuple(option.key, option.text(), option.isText(), option.unit,
                                 option.range(), option.meaning, option.users()));
    return rows;
  });
}

}  // namespace spring_pendulum::python
