// The maximum norm of many packs.
#pragma once

#include "integration/kernels/instruction_sets/pack.hpp"

#include <cstdint>
#include <cstring>

namespace spring_pendulum {
namespace {

/// A maximum of absolute values that becomes NaN if a value is not finite. It compares the bits of
/// the numbers as integers: those of infinity and NaN are larger than those of finite numbers. A
/// comparison of the numbers would ignore NaN.
class Largest {
 public:
  [[gnu::always_inline]] void add(Pack value) {
    const Pack::Bits bits = absoluteBits(value);
    largest_ = bits > largest_ ? bits : largest_;
  }
  [[gnu::always_inline]] double result() const {
    std::int64_t largest = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (largest_[lane] > largest) largest = largest_[lane];
    }
    double result = 0.0;
    std::memcpy(&result, &largest, sizeof(result));
    return result + (result - result);
  }

 private:
  Pack::Bits largest_{};
};

}  // namespace
}  // namespace spring_pendulum
