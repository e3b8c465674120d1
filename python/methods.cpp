// The table of methods.
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include <algorithm>

#include "binding.hpp"

namespace spring_pendulum::python {
namespace {

using namespace py::literals;

/// \param rows stage i has the coefficients of the i stages before it; more must be 0
ButcherTableau toTableau(const py::sequence& rows, const py::object& weights) {
  const Numbers b = toNumbers(weights, "b", 1);
  constexpr auto kMost = static_cast<py::ssize_t>(ButcherTableau::kMaxStages);
  if (b.size() < 1 || b.size() > kMost || static_cast<py::ssize_t>(rows.size()) != b.size())
    throw InputError(
        fmt::format("a and b: must have one row and one weight for each of 1 to {} stages", kMost));
  ButcherTableau tableau;
  tableau.stages = static_cast<std::size_t>(b.size());
  std::copy_n(b.data(), b.size(), tableau.b.begin());
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    const std::string name = fmt::format("a[{}]", i);
    const Numbers row = toNumbers(rows[i], name, 1);
    if (row.size() > b.size())
      throw InputError(fmt::format("{}: at most {} numbers", name, b.size()));
    std::copy_n(row.data(), row.size(), tableau.a[i].begin());
  }
  return tableau;
}

const Method& addMethod(const std::string& name, const py::sequence& a, const py::object& b,
                        const std::string& reference, const std::string& use) {
  if (Computation::running > 0)
    throw InputError("register methods while no other thread integrates");
  const ButcherTableau tableau = toTableau(a, b);
  Method method = methodOfTableau(name, tableau);
  method.reference = reference;
  method.use = use;
  registerMethod(method);
  return methodTable().back();
}

}  // namespace

void defineMethods(py::module_& module) {
  py::class_<Method>(module, "Method", "One row of the method table.")
      .def_readonly("name", &Method::name)
      .def_readonly("order", &Method::order)
      .def_readonly("stages", &Method::stages, "Force evaluations per step.")
      .def_readonly("real_stability_limit", &Method::real_stability_limit,
                    "Largest h |lambda| for lambda on the negative real axis.")
      .def_readonly("imaginary_stability_limit", &Method::imaginary_stability_limit,
                    "Largest h |lambda| for lambda on the imaginary axis; 0: unstable at any step.")
      .def_readonly("reference", &Method::reference)
      .def_readonly("use", &Method::use, "When to use the method.")
      .def_readonly("symplectic", &Method::symplectic)
      .def_property_readonly("fixed_step", &Method::hasFixedStep,
                             "Whether the method takes time_step; if not, a tolerance.")
      .def("__repr__",
           [](const Method& m) { return fmt::format("<Method {}, order {}>", m.name, m.order); });
  module.def(
      "methods",
      [] {
        py::list rows;
        for (const Method& method : methodTable())
          rows.append(py::cast(&method, py::return_value_policy::reference));
        return rows;
      },
      "Returns all methods, in the order of the documentation.");
  module.def("find_method", &findMethod, "name"_a, py::return_value_policy::reference,
             "Returns a method by its name; case and punctuation do not matter.");
  module.def(
      "register_method", &addMethod, "name"_a, py::kw_only(), "a"_a, "b"_a, "reference"_a = "",
      "use"_a = "", py::return_value_policy::reference,
      R"(Adds an explicit Runge-Kutta method with a fixed step to the table, for all functions.

Order and stability limits follow from the coefficients.

Args:
    name: not yet in the table
    a: one row for each stage; row i has the coefficients of the stages before it
    b: the weights; they add up to 1
    reference, use: texts for methods()

Returns:
    the new row of the table
)");
}

}  // namespace spring_pendulum::python
