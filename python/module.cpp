// The Python module `spring_pendulum._core`: errors, conversions and Ctrl-C.
#include <spring_pendulum/base/errors.hpp>

#include <algorithm>
#include <exception>
#include <pthread.h>
#include <string_view>
#include <thread>

#include "binding.hpp"

namespace spring_pendulum::python {

std::string reprOf(const py::handle& value) {
  constexpr std::size_t kLongest = 60;
  auto text = py::reinterpret_steal<py::object>(PyObject_Repr(value.ptr()));
  if (!text) {  // an integer of over 4300 digits
    PyErr_Clear();
    return "a value without a text";
  }
  text = text.attr("replace")("\n", " ");
  std::string whole = py::str(text.attr("encode")("utf-8", "replace").attr("decode")());
  if (py::len(text) <= kLongest) return whole;
  return py::str(py::str(whole)[py::slice(0, kLongest, 1)]).cast<std::string>() + "...";
}

Numbers toNumbers(const py::object& argument, const std::string& name, py::ssize_t dimensions) {
  const auto refuse = [&](const std::string& got) {
    throw InputError(name + ": must be numbers in an array with ndim " +
                     std::to_string(dimensions) + ", got " + got);
  };
  py::array array;
  try {
    array = py::module_::import("numpy").attr("asarray")(argument);
  } catch (py::error_already_set& error) {  // NumPy cannot make an array of this
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    refuse(reprOf(argument));
  }
  if (std::string_view("fiu").find(array.dtype().kind()) == std::string_view::npos ||
      py::module_::import("numpy.ma").attr("is_masked")(argument).cast<bool>())
    refuse(reprOf(argument));
  if (array.ndim() != dimensions) refuse("shape " + reprOf(array.attr("shape")));
  return {array};
}

bool Interruption::operator()() {
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  if (stopped_ || now - asked_ < 20ms) return stopped_;
  asked_ = now;
  const py::gil_scoped_acquire acquired;
  return stopped_ = Computation::isEnding() || PyErr_CheckSignals() != 0;
}

bool Computation::isEnding() {
  if (ending) PyErr_SetString(PyExc_SystemExit, "Python ends");
  return ending;
}

void Computation::end() {
  ending = true;
  const py::gil_scoped_release released;
  while (running > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
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
  static PyObject* const kInputError =
      PyErr_NewExceptionWithDoc("spring_pendulum.InputError",
                                "A wrong argument or a malformed file.", PyExc_ValueError, nullptr);
  static PyObject* const kFileError =
      PyErr_NewExceptionWithDoc("spring_pendulum.FileError",
                                "A file that cannot be read or written.", PyExc_OSError, nullptr);
  module.add_object("InputError", kInputError);
  module.add_object("FileError", kFileError);
  // NOLINTNEXTLINE(performance-unnecessary-value-param): the signature is that of pybind11
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      setError(kInputError, error);
    } catch (const FileError& error) {
      setError(kFileError, error);
    }
  });
}

/// Pickles with every protocol as with 2: 0 and 1 make an object of pybind11's base class, which aborts.
py::tuple reduce(const py::object& self) {
  const py::object type = py::type::of(self);
  if (!py::hasattr(type, "__setstate__"))
    throw py::type_error("cannot pickle " + reprOf(type.attr("__name__")) + " object");
  return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"), py::make_tuple(type),
                        self.attr("__getstate__")());
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The C++ library spring_pendulum; import spring_pendulum instead.";
  py::dtype::of<double>();  // loads NumPy, where threads that do so at once wait forever
  defineErrors(module);
  defineMethods(module);
  defineIntegration(module);
  defineSimulation(module);
  pthread_atfork(nullptr, nullptr, [] { Computation::running = 0; });  // their threads are gone
  py::module_::import("atexit").attr("register")(py::cpp_function(&Computation::end));
  for (const char* name : {"Chain", "State", "Integrator", "Method"}) {
    const py::object type = module.attr(name);
    type.attr("__reduce__") = py::cpp_function(&reduce, py::is_method(type));
  }
}

}  // namespace spring_pendulum::python
