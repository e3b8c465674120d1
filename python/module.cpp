// The Python module `spring_pendulum._core`: errors, conversions and Ctrl-C.
#include <spring_pendulum/base/errors.hpp>

#include <algorithm>
#include <exception>

#include "binding.hpp"

namespace spring_pendulum::python {

std::atomic<int> Computation::running{0};

std::string reprOf(const py::handle& value) {
  constexpr std::size_t kLongest = 60;
  const py::str text = py::repr(value).attr("replace")("\n", " ");
  std::string whole = py::str(text.attr("encode")("utf-8", "replace").attr("decode")());
  if (py::len(text) <= kLongest) return whole;
  return py::str(py::str(whole)[py::slice(0, kLongest, 1)]).cast<std::string>() + "...";
}

Numbers toNumbers(const py::object& argument, const std::string& name, py::ssize_t dimensions) {
  const auto refuse = [&](const std::string& got) {
    throw InputError(name + ": must be numbers in an array of " + std::to_string(dimensions) +
                     (dimensions == 1 ? " dimension, got " : " dimensions, got ") + got);
  };
  try {
    const py::array array = py::module_::import("numpy").attr("asarray")(argument);
    const auto kind = array.dtype().attr("kind").cast<std::string>();
    if (kind != "f" && kind != "i" && kind != "u") refuse(reprOf(argument));
    if (array.ndim() != dimensions) refuse("shape " + reprOf(array.attr("shape")));
    return {array};
  } catch (py::error_already_set& error) {  // NumPy cannot make an array of this
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
  }
  refuse(reprOf(argument));
  return {};
}

bool Interruption::operator()() {
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  if (stopped_ || now - asked_ < 20ms) return stopped_;
  asked_ = now;
  const py::gil_scoped_acquire acquired;
  return stopped_ = PyErr_CheckSignals() != 0;
}

void Interruption::raise() const {
  if (stopped_) throw py::error_already_set();
}

namespace {

/// Makes a Python exception of one line. A file name in it may have line breaks, or not be UTF-8.
void setError(const py::handle& type, const std::exception& error) {
  std::string line = error.what();
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20; }, '?');
  const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefault(line.c_str()));
  PyErr_SetObject(type.ptr(), text.ptr());
}

void defineErrors(py::module_& module) {
  static PyObject* input_error = nullptr;  // for the lifetime of the interpreter
  static PyObject* file_error = nullptr;
  const auto define = [&](const char* name, const char* doc, PyObject* base) {
    const std::string full_name = std::string("spring_pendulum.") + name;
    PyObject* const type = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, base, nullptr);
    if (type == nullptr) throw py::error_already_set();
    module.add_object(name, type);
    return type;
  };
  input_error = define("InputError", "A wrong argument or a malformed file.", PyExc_ValueError);
  file_error = define("FileError", "A file that cannot be read or written.", PyExc_OSError);
  // NOLINTNEXTLINE(performance-unnecessary-value-param): the signature is that of pybind11
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      setError(input_error, error);
    } catch (const FileError& error) {
      setError(file_error, error);
    }
  });
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The C++ library spring_pendulum; import spring_pendulum instead.";
  defineErrors(module);
  defineMethods(module);
  defineIntegration(module);
  defineSimulation(module);
}

}  // namespace spring_pendulum::python
