#include "model/numbers.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/errors.hpp>
#include <spring_pendulum/simulation/parameters.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace spring_pendulum {
namespace {

constexpr double kAnyNumber = -std::numeric_limits<double>::infinity();

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

[[noreturn]] void refuse(const Parameter& parameter, std::string_view text,
                         std::string_view where) {
  throw InputError(fmt::format("{}: {} is '{}': must be {}{}{}", where, parameter.key, text,
                               parameter.range, parameter.unit.empty() ? "" : " ", parameter.unit));
}

std::string prefixFor(std::string_view where) {
  return where.empty() ? "" : fmt::format("{}: ", where);
}

bool inRange(const Parameter& parameter, double value) {
  return std::isfinite(value) &&
         (value > parameter.least || (parameter.least_allowed && value == parameter.least));
}

bool isChoice(const Parameter& parameter, std::string_view text) {
  const auto& choices = parameter.choices;
  return choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end();
}

/// Frame times are computed from a whole number of steps.
void checkLength(const Scenario& scenario, bool fixed) {
  const std::int64_t steps = fixed ? scenario.steps_per_frame : 1;
  if (scenario.frames <= std::numeric_limits<std::int64_t>::max() / steps) return;
  throw InputError(
      fmt::format("frames is '{}' and steps_per_frame is '{}': must be at most {} steps in all",
                  scenario.frames, steps, std::numeric_limits<std::int64_t>::max()));
}

std::optional<bool> parseBool(std::string_view text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return std::nullopt;
}

}  // namespace

const std::vector<Parameter>& parameterTable() {
  static const std::vector<Parameter> kTable{
      {"method", &Scenario::method, "", "the name of a method", "how the chain is integrated"},
      {"particles", &Scenario::particles, "", "a file", "the particle file, a line \"x y m\" each"},
      {"output", &Scenario::output, "", "a folder", "where frame files go; made if absent"},
      {"no_frames", &Scenario::no_frames, "", "true or false", "write no frame files"},
      {"energy", &Scenario::energy, "", "a file", "CSV file for the energy ledger, a row a frame"},
      {"on_divergence",
       &Scenario::on_divergence,
       "",
       "stop or continue",
       "whether a motion that diverged is carried on as long as every number is finite",
       AppliesTo::kAllMethods,
       0.0,
       false,
       {"stop", "continue"}},
      {"frames", &Scenario::frames, "", "a whole number of at least 1", "number of frames",
       AppliesTo::kAllMethods, 1.0, true},
      {"steps_per_frame", &Scenario::steps_per_frame, "", "a whole number of at least 1",
       "integration steps from one frame to the next", AppliesTo::kFixedStep, 1.0, true},
      {"time_step", &Scenario::time_step, "s", "a number above 0", "integration step",
       AppliesTo::kFixedStep, 0.0, false},
      {"tolerance", &Scenario::tolerance, "m", "a number above 0",
       "largest position error aimed at", AppliesTo::kErrorControlled, 0.0, false},
      {"frame_interval", &Scenario::frame_interval, "s", "a number above 0",
       "time from one frame to the next", AppliesTo::kErrorControlled, 0.0, false},
      {"stiffness", &Scenario::stiffness, "N/m", "a number of at least 0", "spring constant k_s",
       AppliesTo::kAllMethods, 0.0, true},
      {"damping", &Scenario::damping, "N·s/m", "a number of at least 0", "damping constant k_d",
       AppliesTo::kAllMethods, 0.0, true},
      {"rest_length", &Scenario::rest_length, "m", "a number of at least 0",
       "length L_0 of a spring without force", AppliesTo::kAllMethods, 0.0, true},
      {"gravity", &Scenario::gravity, "m/s²", "a finite number", "g, acting downwards",
       AppliesTo::kAllMethods, kAnyNumber, false},
      {"threads", &Scenario::threads, "", "a whole number of at least 0",
       "at most so many threads integrate, 0: as many as the processor runs at once",
       AppliesTo::kAllMethods, 0.0, true},
      {"sleep", &Scenario::sleep, "m/s", "a number of at least 0",
       "a chain slower than this, and not about to be faster, is not stepped, 0: always stepped",
       AppliesTo::kAllMethods, 0.0, true},
  };
  return kTable;
}

const Parameter& findParameter(std::string_view key, std::string_view where) {
  std::string known;
  for (const Parameter& parameter : parameterTable()) {
    if (parameter.key == key) return parameter;
    known += known.empty() ? "" : ", ";
    known += parameter.key;
  }
  throw InputError(
      fmt::format("{}unknown parameter '{}': known are {}", prefixFor(where), key, known));
}

std::string formatValue(const Parameter& parameter, const Scenario& scenario) {
  return std::visit([&](auto member) { return fmt::format("{}", scenario.*member); },
                    parameter.member);
}

void ScenarioBuilder::set(std::string_view key, std::string_view text, std::string_view where) {
  const Parameter& parameter = findParameter(key, where);
  const auto store = Overloaded{
      [&](double Scenario::*member) {
        const std::optional<double> value = parseNumber(text);
        if (!value || !inRange(parameter, *value)) refuse(parameter, text, where);
        scenario_.*member = *value;
      },
      [&](std::int64_t Scenario::*member) {
        const std::optional<std::int64_t> value = parseInteger(text);
        if (!value || !inRange(parameter, static_cast<double>(*value))) {
          refuse(parameter, text, where);
        }
        scenario_.*member = *value;
      },
      [&](bool Scenario::*member) {
        const std::optional<bool> value = parseBool(text);
        if (!value) refuse(parameter, text, where);
        scenario_.*member = *value;
      },
      [&](std::string Scenario::*member) {
        const bool may_be_empty = (Scenario{}.*member).empty();
        if (text.empty() && !may_be_empty) refuse(parameter, text, where);
        if (!isChoice(parameter, text)) refuse(parameter, text, where);
        scenario_.*member = std::string(text);
      },
  };
  std::visit(store, parameter.member);
  given_.insert_or_assign(std::string(key), std::string(where));
}

const Method& ScenarioBuilder::findGivenMethod() const {
  try {
    return findMethod(scenario_.method);
  } catch (const InputError& error) {
    throw InputError(prefixFor(given_.at("method")) + error.what());  // the default is known
  }
}

Scenario ScenarioBuilder::build() const {
  const Method& method = findGivenMethod();
  const bool fixed = method.control == StepControl::kFixed;
  for (const auto& [key, where] : given_) {
    const AppliesTo applies_to = findParameter(key).applies_to;
    if (applies_to == AppliesTo::kAllMethods) continue;
    if (fixed == (applies_to == AppliesTo::kFixedStep)) continue;
    throw InputError(
        fmt::format("{}{} has no meaning for {}, {}", prefixFor(where), key, method.name,
                    fixed ? "a fixed-step method: it is told time_step and steps_per_frame"
                          : "which controls its error: it is told tolerance and frame_interval"));
  }
  checkLength(scenario_, fixed);
  return scenario_;
}

}  // namespace spring_pendulum
