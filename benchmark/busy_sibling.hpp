// Another program on the second thread of a processor core.
#pragma once

#include <csignal>
#include <fstream>
#include <sched.h>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace spring_pendulum::benchmark {

/// Pins this process to its processor and, while the object exists, keeps the other thread of its core
/// busy with multiplications and additions.
class BusySibling {
 public:
  /// \throws std::runtime_error if the core has one thread only
  BusySibling() {
    const int processor = sched_getcpu();
    sibling_ = siblingOf(processor);
    pinTo(processor);
    child_ = fork();
    if (child_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    pinTo(sibling_);
    compute();
  }
  ~BusySibling() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  BusySibling(const BusySibling&) = delete;
  BusySibling& operator=(const BusySibling&) = delete;

  /// For the head of a result file.
  std::string description() const {
    return "beside a program of multiplications and additions on processor " +
           std::to_string(sibling_) + ", the other thread of the core";
  }

 private:
  /// The first other processor in a list such as "0,4" or "0-1".
  static int siblingOf(int processor) {
    std::ifstream list("/sys/devices/system/cpu/cpu" + std::to_string(processor) +
                       "/topology/thread_siblings_list");
    for (int sibling = 0; list >> sibling; list.ignore()) {
      if (sibling != processor) return sibling;
    }
    throw std::runtime_error("no busy sibling: each core has one thread only");
  }
  static void pinTo(int processor) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(processor, &set);
    sched_setaffinity(0, sizeof(set), &set);
  }
  [[noreturn]] static void compute() {
    [[maybe_unused]] static volatile double result;
    for (double a = 1.0, b = 2.0, c = 3.0, d = 4.0;; result = a + b + c + d) {
      for (int i = 0; i < 1000; ++i) {
        a = a * 0.999 + 0.001;
        b = b * 0.999 + 0.002;
        c = c * 0.999 + 0.003;
        d = d * 0.999 + 0.004;
      }
    }
  }

  int sibling_ = 0;
  pid_t child_ = 0;
};

}  // namespace spring_pendulum::benchmark
