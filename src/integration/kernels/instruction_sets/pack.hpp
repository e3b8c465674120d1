// Several doubles in one vector register, with the arithmetic of a double.
//
// Only `fused` fuses multiplications and additions, never the compiler, so results do not depend on
// the instruction set. Processors without a fused multiply-add emulate it exactly.
//
// Every file that includes this header is compiled for a different instruction set. All names have
// internal linkage. Otherwise the linker could merge functions of the same name, and an older
// processor would run one compiled for AVX-512.
#pragma once

#include <spring_pendulum/model/spring_law.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#if defined(__FMA__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#else
#include "integration/kernels/instruction_sets/emulated_fused.hpp"
#endif

namespace spring_pendulum {
namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 8;
#elif defined(__AVX2__) && defined(__FMA__)
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif

/// `kLanes` doubles, as a vector type that GCC and Clang support on every processor. An operation
/// acts on each double and is rounded as for a single double.
struct Pack {
  using Native [[gnu::vector_size(kLanes * sizeof(double))]] = double;
  using Bits [[gnu::vector_size(kLanes * sizeof(double))]] = std::int64_t;

  Pack() = default;
  // NOLINTBEGIN(google-explicit-constructor): doubles and vectors mix as in a formula
  [[gnu::always_inline]] Pack(Native native) : lanes(native) {}
  [[gnu::always_inline]] Pack(double in_every_lane) : lanes(in_every_lane - Native{}) {}
  // NOLINTEND(google-explicit-constructor)

  [[gnu::always_inline]] static Pack load(const double* aligned) {
    return {*reinterpret_cast<const Native*>(aligned)};
  }
  [[gnu::always_inline]] static Pack loadUnaligned(const double* from) {
    using Unaligned [[gnu::vector_size(kLanes * sizeof(double)), gnu::aligned(8)]] = double;
    return {*reinterpret_cast<const Unaligned*>(from)};
  }
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
[[gnu::always_inline]] inline Pack operator-(Pack a) {
  return {-a.lanes};
}

/// Returns a b + c, rounded once.
[[gnu::always_inline]] inline Pack fused(Pack a, Pack b, Pack c) {
#if defined(__AVX512F__)
  return {_mm512_fmadd_pd(a.lanes, b.lanes, c.lanes)};
#elif defined(__FMA__)
  return {_mm256_fmadd_pd(a.lanes, b.lanes, c.lanes)};
#elif defined(__aarch64__)
  return {vfmaq_f64(c.lanes, a.lanes, b.lanes)};
#else
  return {emulatedFused(a.lanes, b.lanes, c.lanes)};
#endif
}

[[gnu::always_inline]] inline Pack squareRoot(Pack square) {
  Pack root;
  for (int lane = 0; lane < kLanes; ++lane) root.lanes[lane] = std::sqrt(square.lanes[lane]);
  return root;
}

[[gnu::always_inline]] inline Pack inverseOrZero(Pack length) {
  return {length.lanes > 0.0 ? 1.0 / length.lanes : Pack::Native{}};
}

/// Applies `inverseSquareRoot(double)` to each lane.
[[gnu::always_inline]] inline Pack inverseSquareRoot(Pack square) {
  return {square.lanes > 0.0 ? 1.0 / squareRoot(square).lanes : Pack::Native{}};
}

/// Returns the bits of the absolute values.
[[gnu::always_inline]] inline Pack::Bits absoluteBits(Pack a) {
  return reinterpret_cast<Pack::Bits>(a.lanes) & std::int64_t{0x7fffffffffffffff};
}

[[gnu::always_inline]] inline Pack absolute(Pack a) {
  return {reinterpret_cast<Pack::Native>(absoluteBits(a))};
}

/// Returns `kLanes` lanes of the concatenation of a and b, from lane `kFirst` on.
template <int kFirst, int... kLane>
[[gnu::always_inline]] inline Pack lanesFrom(Pack a, Pack b, std::integer_sequence<int, kLane...>) {
#if defined(__clang__)
  return {__builtin_shufflevector(a.lanes, b.lanes, (kFirst + kLane)...)};
#else
  using Selection [[gnu::vector_size(kLanes * sizeof(double))]] = long long;
  return {__builtin_shuffle(a.lanes, b.lanes, Selection{(kFirst + kLane)...})};
#endif
}

/// Returns the right neighbour of each lane, where `right` follows `here` in the chain.
[[gnu::always_inline]] inline Pack rightNeighbours(Pack here, Pack right) {
  return lanesFrom<1>(here, right, std::make_integer_sequence<int, kLanes>());
}

/// Returns the left neighbour of each lane, where `left` precedes `here` in the chain.
[[gnu::always_inline]] inline Pack leftNeighbours(Pack left, Pack here) {
  return lanesFrom<kLanes - 1>(left, here, std::make_integer_sequence<int, kLanes>());
}

/// Returns 0, 1, 2, ..., kLanes - 1.
[[gnu::always_inline]] inline Pack laneNumbers() {
  Pack numbers;
  for (int lane = 0; lane < kLanes; ++lane) numbers.lanes[lane] = lane;
  return numbers;
}

/// Returns the first `count` lanes of `pack`, and 0 in all others.
[[gnu::always_inline]] inline Pack only(Pack pack, std::ptrdiff_t count) {
  return {laneNumbers().lanes < static_cast<double>(count) ? pack.lanes : Pack::Native{}};
}

}  // namespace
}  // namespace spring_pendulum
