// Chain, State and Integrator.
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"

namespace spring_pendulum::python {
namespace {

using namespace py::literals;

/// A view of memory that its owner keeps alive.
using View = py::array_t<double, py::array::f_style>;

State makeState(const py::object& x, const py::object& y, const py::object& vx,
                const py::object& vy) {
  State state(toNumbers(x, "x", 1).size());
  const auto fill = [&](const py::object& argument, const char* name, auto column) {
    if (argument.is_none()) return;
    const Numbers numbers = toNumbers(argument, name, 1);
    if (numbers.size() != state.size())
      throw InputError(fmt::format("{}: must have as many numbers as x, {}, got {}", name,
                                   state.size(), numbers.size()));
    for (py::ssize_t i = 0; i < numbers.size(); ++i) {
      column[i] = *numbers.data(i) + 0.0;
      if (!std::isfinite(column[i]))
        throw InputError(fmt::format("{}[{}]: must be finite, got {}", name, i, column[i]));
    }
  };
  fill(x, "x", state.x());
  fill(y, "y", state.y());
  fill(vx, "vx", state.vx());
  fill(vy, "vy", state.vy());
  return state;
}

/// An integrator of one chain. It can be used by one thread at a time.
class PythonIntegrator {
 public:
  PythonIntegrator(const Method& method, Chain chain, const IntegratorOptions& options)
      : method_(method),
        chain_(std::move(chain)),
        tolerance_(options.tolerance),
        integrator_(makeIntegrator(method_, chain_, options)) {}

  void advance(State& state, double time_step, std::int64_t steps) {
    const auto used = use();
    integrator_->advance(state, time_step, steps < 0 ? steps : 0);  // checks the arguments
    if (!method_.hasFixedStep()) checkTolerance(tolerance_, chain_, state);
    if (steps > 0) tolerance_ = INFINITY;  // only at the start, like a run
    Interruption interruption;
    {
      const Computation computation;
      integrator_->advance(state, time_step, steps, [&] { return interruption(); });
    }
    if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  }

  void restart() {
    const auto used = use();
    integrator_->restart();
  }

  const Method& method() const { return method_; }
  const Chain& chain() const { return chain_; }
  const Integrator& integrator() const {
    const auto used = use();
    return *integrator_;
  }

 private:
  /// Refuses a second thread during the lifetime of the result.
  std::shared_ptr<void> use() const {
    if (busy_.exchange(true)) throw InputError("another thread uses this integrator");
    return {nullptr, [this](void*) { busy_ = false; }};
  }

  const Method& method_;
  Chain chain_;
  double tolerance_;
  std::unique_ptr<Integrator> integrator_;
  mutable std::atomic<bool> busy_{false};
};

void defineChain(py::module_& module) {
  constexpr SpringLaw kSpring;
  const auto make = [](const py::object& masses, double stiffness, double damping,
                       double rest_length, double gravity, double air_drag) {
    const Numbers numbers = toNumbers(masses, "masses", 1);
    const AlignedNumbers aligned =
        Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size());
    return Chain(aligned, {{stiffness, damping, rest_length}, gravity, air_drag});
  };
  py::class_<Chain>(module, "Chain",
                    "N particles joined by N - 1 equal springs; the first is fixed.")
      .def(py::init(make), "masses"_a, py::kw_only(), "stiffness"_a = kSpring.stiffness,
           "damping"_a = kSpring.damping, "rest_length"_a = kSpring.rest_length,
           "gravity"_a = Constants{}.gravity, "air_drag"_a = Constants{}.air_drag)
      .def_property_readonly("masses",
                             [](const py::object& self) {
                               const auto& chain = self.cast<const Chain&>();
                               View view({chain.size()}, chain.masses().data(), self);
                               view.attr("setflags")("write"_a = false);
                               return view;
                             })
      .def_property_readonly("stiffness", [](const Chain& c) { return c.spring().stiffness; })
      .def_property_readonly("damping", [](const Chain& c) { return c.spring().damping; })
      .def_property_readonly("rest_length", [](const Chain& c) { return c.spring().rest_length; })
      .def_property_readonly("gravity", &Chain::gravity)
      .def_property_readonly("air_drag", &Chain::airDrag)
      .def("__len__", &Chain::size)
      .def("__repr__",
           [](const Chain& c) { return fmt::format("<Chain of {} particles>", c.size()); })
      .def(py::pickle(
          [](const Chain& c) {
            return py::make_tuple(py::array_t<double>(c.size(), c.masses().data()),
                                  c.spring().stiffness, c.spring().damping, c.spring().rest_length,
                                  c.gravity(), c.airDrag());
          },
          [make](const py::tuple& t) {
            return make(t[0], t[1].cast<double>(), t[2].cast<double>(), t[3].cast<double>(),
                        t[4].cast<double>(), t[5].cast<double>());
          }));
}

template <int kFirst, int kColumns>
py::array stateView(const py::object& self) {
  auto& state = self.cast<State&>();
  std::vector<py::ssize_t> shape{state.size()};
  if (kColumns > 1) shape.push_back(kColumns);
  return View(shape, state.values().data() + kFirst * state.size(), self);
}

void defineState(py::module_& module) {
  py::class_<State>(module, "State", "Positions (m) and velocities (m/s) of N particles.")
      .def(py::init(&makeState), "x"_a, "y"_a, "vx"_a = py::none(), "vy"_a = py::none())
      .def_property_readonly("x", &stateView<0, 1>)
      .def_property_readonly("y", &stateView<1, 1>)
      .def_property_readonly("vx", &stateView<2, 1>)
      .def_property_readonly("vy", &stateView<3, 1>)
      .def_property_readonly("positions", &stateView<0, 2>)
      .def_property_readonly("velocities", &stateView<2, 2>)
      .def("__len__", &State::size)
      .def("__repr__",
           [](const State& s) { return fmt::format("<State of {} particles>", s.size()); })
      .def(py::pickle(
          [](const State& s) {
            return py::make_tuple(py::array_t<double>(s.values().size(), s.values().data()));
          },
          [](const py::tuple& t) {  // not by makeState: a state that diverged is not finite
            const Numbers numbers = toNumbers(t[0], "state", 1);
            State state(numbers.size() / 4);
            std::copy_n(numbers.data(), state.values().size(), state.values().data());
            return state;
          }));
}

void defineIntegrator(py::module_& module) {
  constexpr IntegratorOptions kDefaults;
  const auto make = [](const std::string& name, const Chain& chain, std::optional<double> tolerance,
                       bool track_dissipation, int threads) {
    const Method& method = findMethod(name);
    if (tolerance && method.hasFixedStep())
      throw InputError(fmt::format(
          "tolerance: {} takes fixed steps; choose the time_step of advance", method.name));
    return std::make_unique<PythonIntegrator>(
        method, chain,
        IntegratorOptions{tolerance.value_or(IntegratorOptions().tolerance), track_dissipation,
                          threads});
  };
  py::class_<PythonIntegrator>(module, "Integrator", "Advances a state; restart() before another.")
      .def("advance", &PythonIntegrator::advance, "state"_a, "time_step"_a, "steps"_a)
      .def("restart", &PythonIntegrator::restart)
      .def_property_readonly("method", [](const PythonIntegrator& i) { return i.method().name; })
      .def_property_readonly("chain", &PythonIntegrator::chain)
      .def_property_readonly(
          "force_evaluations",
          [](const PythonIntegrator& i) { return i.integrator().forceEvaluations(); })
      .def_property_readonly(
          "dissipated_energy",
          [](const PythonIntegrator& i) { return i.integrator().dissipatedEnergy(); })
      .def("__repr__", [](const PythonIntegrator& i) {
        return fmt::format("<Integrator {}, {} particles>", i.method().name, i.chain().size());
      });
  module.def("make_integrator", make, "method"_a, "chain"_a, py::kw_only(),
             "tolerance"_a = py::none(), "track_dissipation"_a = kDefaults.track_dissipation,
             "threads"_a = kDefaults.threads);
}

}  // namespace

void defineIntegration(py::module_& module) {
  defineChain(module);
  defineState(module);
  defineIntegrator(module);
}

}  // namespace spring_pendulum::python
