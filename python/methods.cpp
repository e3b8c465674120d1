// The table of methods.
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include "binding.hpp"

namespace spring_pendulum::python {

void defineMethods(py::module_& module) {
  py::class_<Method>(module, "Method", "One row of the method table.")
      .def_readonly("name", &Method::name)
      .def_readonly("order", &Method::order)
      .def_readonly("stages", &Method::stages)
      .def_readonly("real_stability_limit", &Method::real_stability_limit)
      .def_readonly("imaginary_stability_limit", &Method::imaginary_stability_limit)
      .def_readonly("reference", &Method::reference)
      .def_readonly("use", &Method::use)
      .def_readonly("symplectic", &Method::symplectic)
      .def_property_readonly("fixed_step", &Method::hasFixedStep)
      .def("__repr__", [](const Method& method) {
        return fmt::format("<Method {}, order {}>", method.name, method.order);
      });
  module.def("methods", [] {
    py::list rows;
    for (const Method& method : methodTable()) {
      rows.append(py::cast(&method, py::return_value_policy::reference));
    }
    return rows;
  });
}

}  // namespace spring_pendulum::python
