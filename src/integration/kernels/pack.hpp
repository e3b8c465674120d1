// Several doubles in one vector register, with the arithmetic of a double.
//
// Every file that includes this is compiled for another instruction set. All names have internal
// linkage, so that the linker can never take a function compiled for AVX-512 for one of the same
// name that an older processor is to run.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

namespace spring_pendulum {
namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 8;
#elif defined(__AVX2__)
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif

/// `kLanes` doubles. GCC and Clang know this type on every processor; an operation on it is the
/// operation on each double, rounded alike.
struct Pack {
  using Native [[gnu::vector_size(kLanes * sizeof(double))]] = double;

  [[gnu::always_inline]] static Pack load(const double* aligned) {
    return {*reinterpret_cast<const Native*>(aligned)};
  }
  [[gnu::always_inline]] static Pack all(double value) { return {value - Native{}}; }
  [[gnu::always_inline]] void store(double* aligned) const {
    *reinterpret_cast<Native*>(aligned) = lanes;
  }

  Native lanes{};
};

[[gnu::always_inline]] inline Pack operator+(Pack a, Pack b) {
  return {a.lanes + b.lanes};
}
[[gnu::always_inline]] inline Pack operator-(Pack a, Pack b) {
  return {a.lanes - b.lanes};
}
[[gnu::always_inline]] inline Pack operator*(Pack a, Pack b) {
  return {a.lanes * b.lanes};
}
[[gnu::always_inline]] inline Pack operator+(double a, Pack b) {
  return {a + b.lanes};
}
[[gnu::always_inline]] inline Pack operator-(Pack a, double b) {
  return {a.lanes - b};
}
[[gnu::always_inline]] inline Pack operator*(double a, Pack b) {
  return {a * b.lanes};
}

/// As the function of a double of the same name.
[[gnu::always_inline]] inline Pack inverseSquareRoot(Pack square) {
  Pack root;
  for (int lane = 0; lane < kLanes; ++lane) root.lanes[lane] = std::sqrt(square.lanes[lane]);
  return {square.lanes > 0.0 ? 1.0 / root.lanes : Pack::Native{}};
}

[[gnu::always_inline]] inline Pack absolute(Pack a) {
  return {a.lanes < 0.0 ? -a.lanes : a.lanes};
}

/// The larger of both; `a` where one of them is NaN.
[[gnu::always_inline]] inline Pack larger(Pack a, Pack b) {
  return {b.lanes > a.lanes ? b.lanes : a.lanes};
}

template <int... kLane>
[[gnu::always_inline]] inline Pack shiftedDown(Pack a, Pack b,
                                               std::integer_sequence<int, kLane...>) {
  return {__builtin_shufflevector(a.lanes, b.lanes, (kLane + 1)...)};
}
template <int... kLane>
[[gnu::always_inline]] inline Pack shiftedUp(Pack a, Pack b, std::integer_sequence<int, kLane...>) {
  return {__builtin_shufflevector(a.lanes, b.lanes, (kLane + kLanes - 1)...)};
}

/// Each lane's right neighbour, where `right` follows `here` in the chain.
[[gnu::always_inline]] inline Pack rightNeighbours(Pack here, Pack right) {
  return shiftedDown(here, right, std::make_integer_sequence<int, kLanes>());
}

/// Each lane's left neighbour, where `left` precedes `here` in the chain.
[[gnu::always_inline]] inline Pack leftNeighbours(Pack left, Pack here) {
  return shiftedUp(left, here, std::make_integer_sequence<int, kLanes>());
}

/// 0, 1, 2, ...
[[gnu::always_inline]] inline Pack laneNumbers() {
  Pack numbers;
  for (int lane = 0; lane < kLanes; ++lane) numbers.lanes[lane] = lane;
  return numbers;
}

/// `pack` where begin <= lane < end, else 0.
[[gnu::always_inline]] inline Pack only(Pack pack, std::ptrdiff_t begin, std::ptrdiff_t end) {
  const Pack lane = laneNumbers();
  const Pack above = {lane.lanes < static_cast<double>(end) ? pack.lanes : Pack::Native{}};
  return {lane.lanes >= static_cast<double>(begin) ? above.lanes : Pack::Native{}};
}

}  // namespace
}  // namespace spring_pendulum
