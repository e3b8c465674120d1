// What the parts of the Python module share.
#pragma once

#include <spring_pendulum/model/state.hpp>

#include <atomic>
#include <chrono>
#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>

namespace spring_pendulum::python {

namespace py = pybind11;

/// Numbers from anything that NumPy converts: a list, float32, any order of the memory.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Converts an argument, and names it in the error.
/// \throws InputError unless it is an array of numbers with this many dimensions
Numbers toNumbers(const py::object& argument, const std::string& name, py::ssize_t dimensions);

/// repr(value) on one line, shortened.
std::string reprOf(const py::handle& value);

/// Lets Python handle Ctrl-C while the library computes without the interpreter lock. Only the main
/// thread of Python receives it.
class Interruption {
 public:
  /// Asks Python at most every 20 ms, and leaves the exception that ends the call, usually
  /// KeyboardInterrupt, in Python.
  bool operator()();

 private:
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  bool stopped_ = false;
};

/// Counts the calls that compute without the interpreter lock. Meanwhile, no method can be registered.
class Computation {
 public:
  /// \throws SystemExit, which ends a thread silently, if Python ends
  Computation() {
    if (isEnding()) throw py::error_already_set();
    ++running;
    released_ = std::make_unique<py::gil_scoped_release>();
  }
  ~Computation() {
    released_.reset();  // while it counts: a thread that takes the lock of an ended Python aborts
    --running;
  }

  /// Stops all computations and waits for them. Python calls it before it ends.
  static void end();
  /// Whether Python ends; sets SystemExit then. Call it with the lock.
  static bool isEnding();

  inline static std::atomic<int> running{0};

 private:
  inline static bool ending = false;
  std::unique_ptr<py::gil_scoped_release> released_;
};

void defineIntegration(py::module_& module);
void defineSimulation(py::module_& module);
void defineMethods(py::module_& module);

}  // namespace spring_pendulum::python
