// The maximum norm of many packs.
#pragma once

#include "integration/kernels/instruction_sets/pack.hpp"

namespace spring_pendulum {
namespace {

/// A maximum of absolute values that becomes NaN if a value is not finite. A comparison alone would
/// ignore NaN.
class Largest {
 public:
  void add(Pack value) {
    largest_ = larger(largest_, absolute(value));
    not_finite_ = not_finite_ + (value - value);
  }
  double result() const {
    double result = 0.0;
    double not_finite = 0.0;
    for (int lane = 0; lane < kLanes; ++lane) {
      result = largest_.lanes[lane] > result ? largest_.lanes[lane] : result;
      not_finite += not_finite_.lanes[lane];
    }
    return result + not_finite;
  }

 private:
  Pack largest_;
  Pack not_finite_;
};

}  // namespace
}  // namespace spring_pendulum
