// Kernels of the Taylor series method. The recursion is derived in taylor_stepper.hpp; u, L, d and
// T below are the quantities of that derivation.
#pragma once

#include "integration/kernels/block.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/instruction_sets/pack.hpp"
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>
#include <utility>

namespace spring_pendulum {
namespace {

using Index = std::ptrdiff_t;
constexpr Index kGroup = 8;  ///< springs of one group in memory, for every instruction set

// Pseudo-orders that select the two rows without coefficients.
constexpr Index kDirection = -2;
constexpr Index kSums = -1;

/// One Taylor coefficient of the separation and the length of a spring.
struct SpringCoefficient {
  PlaneVector<Pack> separation;
  Pack length;
};

/// Partial sums of the convolutions sum_j a_j b_{n-j} that order n needs.
struct Convolutions {
  SpringCoefficient product;  ///< terms of d·d and L L in L_{n+1}; three sums shorten the latency
  Pack quotient;              ///< terms of u L
  PlaneVector<Pack> force;    ///< terms of u d

  /// The sum in L_{n+1}, times L_0.
  [[gnu::always_inline]] Pack length() const {
    return (product.separation.x + product.separation.y) - product.length;
  }
};

/// Reads and writes the coefficients of the springs of one block. The compiler knows the offset of
/// every row, so it keeps in registers what was just stored.
class SpringSeries {
 public:
  [[gnu::always_inline]] SpringSeries(const TaylorWorkspace& work, Index block)
      : first_(work.springs + offsetOf(static_cast<std::size_t>(block * kLanes))) {}

  [[gnu::always_inline]] PlaneVector<Pack> separation(Index n) const {
    return {at(n, 0), at(n, 1)};
  }
  [[gnu::always_inline]] Pack length(Index n) const { return at(n, 2); }
  [[gnu::always_inline]] Pack quotient(Index n) const { return at(n, 3); }
  [[gnu::always_inline]] Convolutions convolutions() const {
    return {{{length(kSums), Pack{}}, Pack{}}, quotient(kSums), separation(kSums)};
  }

  [[gnu::always_inline]] void setSeparation(Index n, const PlaneVector<Pack>& value) {
    value.x.store(row(n));
    value.y.store(row(n) + kGroup);
  }
  [[gnu::always_inline]] void setLength(Index n, Pack value) { value.store(row(n) + 2 * kGroup); }
  [[gnu::always_inline]] void setQuotient(Index n, Pack value) { value.store(row(n) + 3 * kGroup); }
  [[gnu::always_inline]] void setConvolutions(const Convolutions& value) {
    setSeparation(kSums, value.force);
    setLength(kSums, value.length());
    setQuotient(kSums, value.quotient);
  }

 private:
  static constexpr Index kRow = 4 * kGroup;
  // Of unsigned numbers, quotient and remainder by a power of two take one instruction each.
  [[gnu::always_inline]] static std::size_t offsetOf(std::size_t spring) {
    constexpr std::size_t kNumbers = TaylorWorkspace::kSpringRows * kRow;
    return spring / kGroup * kNumbers + spring % kGroup;
  }
  [[gnu::always_inline]] double* row(Index n) const {
    return first_ + (n < 0 ? n + TaylorWorkspace::kSpringRows : n) * kRow;
  }
  [[gnu::always_inline]] Pack at(Index n, Index quantity) const {
    return Pack::load(row(n) + quantity * kGroup);
  }

  double* first_;
};

[[gnu::always_inline]] inline SpringCoefficient coefficient(const SpringSeries& spring, Index n) {
  return {spring.separation(n), spring.length(n)};
}

/// Adds the products of two coefficients to the convolutions d·d and L L.
[[gnu::always_inline]] inline void addProduct(Convolutions& sums, const SpringCoefficient& a,
                                              const SpringCoefficient& b) {
  SpringCoefficient& sum = sums.product;
  sum.separation.x = fused(a.separation.x, b.separation.x, sum.separation.x);
  sum.separation.y = fused(a.separation.y, b.separation.y, sum.separation.y);
  sum.length = fused(a.length, b.length, sum.length);
}

[[gnu::always_inline]] inline SpringCoefficient half(const SpringCoefficient& a) {
  return {{0.5 * a.separation.x, 0.5 * a.separation.y}, 0.5 * a.length};
}

/// Adds the products of u_j and another coefficient to the convolutions u L and u d.
[[gnu::always_inline]] inline void addTerm(Convolutions& sums, Pack quotient,
                                           const SpringCoefficient& other) {
  sums.quotient = fused(quotient, other.length, sums.quotient);
  sums.force.x = fused(quotient, other.separation.x, sums.force.x);
  sums.force.y = fused(quotient, other.separation.y, sums.force.y);
}

/// Adds to the sums of the even order n and of order n + 1 all terms of the coefficients known
/// before order n. Both orders share loads. The terms of the newest coefficients come last, so that
/// all others are computed while those are still under way.
template <Index n>
[[gnu::always_inline]] inline void addKnownTerms(const SpringSeries& spring, Convolutions& here,
                                                 Convolutions& next) {
  if constexpr (n > 0) {
    SpringCoefficient lower = coefficient(spring, n / 2 + 1);
    addProduct(next, half(lower), lower);
#pragma GCC unroll 16
    for (Index j = n / 2; j >= 1; --j) {
      const SpringCoefficient upper = coefficient(spring, n + 1 - j);
      if (j < n / 2) addProduct(next, lower, upper);
      lower = coefficient(spring, j);
      addProduct(here, lower, upper);
    }
#pragma GCC unroll 16
    for (Index j = 1; j < n - 1; ++j) {
      const Pack quotient = spring.quotient(j);
      addTerm(here, quotient, coefficient(spring, n - j));
      if (j > 1) addTerm(next, quotient, coefficient(spring, n + 1 - j));
    }
    const SpringCoefficient newest = coefficient(spring, n);
    const Pack quotient = spring.quotient(n - 1);
    if (n > 2) addTerm(next, spring.quotient(1), newest);
    addTerm(next, quotient, coefficient(spring, 2));
    addTerm(here, spring.quotient(0), newest);
    addTerm(here, quotient, coefficient(spring, 1));
  }
}

/// Adds to the sums of order n + 1 the terms of the coefficients that order n computed.
[[gnu::always_inline]] inline void addNewTerms(const SpringSeries& spring, Index n,
                                               Convolutions& next) {
  const SpringCoefficient first = coefficient(spring, 1);
  const SpringCoefficient newest = coefficient(spring, n + 1);
  addProduct(next, n == 0 ? half(first) : first, newest);
  addTerm(next, spring.quotient(0), newest);
  if (n > 0) addTerm(next, spring.quotient(n), first);
}

/// Stores L_{n+1} and u_n of the springs of one block and returns their force coefficient n, from
/// d_0 to d_{n+1} and the finished sums of order n.
[[gnu::always_inline]] inline PlaneVector<Pack> springCoefficients(const TaylorWorkspace& work,
                                                                   SpringSeries spring, Index n,
                                                                   const Convolutions& sums) {
  const Pack inverse_length = spring.length(kDirection);
  const PlaneVector<Pack> direction = spring.separation(kDirection);
  const PlaneVector<Pack> newest = spring.separation(n + 1);
  const Pack length =
      fused(direction.x, newest.x, fused(direction.y, newest.y, sums.length() * inverse_length));
  spring.setLength(n + 1, length);

  const Pack stretch = n == 0 ? spring.length(0) - work.chain.spring.rest_length : spring.length(n);
  const Pack elastic = fused(work.chain.spring.stiffness, stretch, -sums.quotient) * inverse_length;
  const Pack damping = (work.chain.spring.damping * static_cast<double>(n + 1)) * inverse_length;
  const Pack quotient = fused(damping, length, elastic);
  spring.setQuotient(n, quotient);
  const PlaneVector<Pack> origin = spring.separation(0);
  return {fused(quotient, origin.x, sums.force.x), fused(quotient, origin.y, sums.force.y)};
}

/// Computes the sums of order n, then L_{n+1}, u_n and the force coefficient n. An even order n
/// computes and stores the sums of the odd order n + 1 as well.
template <Index n>
[[gnu::always_inline]] inline PlaneVector<Pack> springCoefficients(const TaylorWorkspace& work,
                                                                   SpringSeries spring) {
  if constexpr (n % 2 == 0) {
    Convolutions here{};
    Convolutions next{};
    addKnownTerms<n>(spring, here, next);
    const PlaneVector<Pack> force = springCoefficients(work, spring, n, here);
    addNewTerms(spring, n, next);
    spring.setConvolutions(next);
    return force;
  } else {
    return springCoefficients(work, spring, n, spring.convolutions());
  }
}

/// Stores d_0, d_1 = w, L_0, 1/L_0 and d_0/L_0 of all springs, from the state.
inline void beginSeries(const TaylorWorkspace& work, const double* state) {
  const Index blocks = blocksOf(work.chain.size);
  Block left = load(placeOf(state, work.chain.pitch, -1));
  for (Index block = 0; block < blocks; ++block) {
    const Block here = load(placeOf(state, work.chain.pitch, block));
    const PlaneVector<Pack> separation = separationsOf(left, here);
    const Pack square = dotProduct(separation, separation);
    // 1/L_0 = 0 makes all forces of a spring 0: in the padding, and where only rounding errors give its direction.
    const Index springs = work.chain.size - 1 - block * kLanes;
    const Pack known{square.lanes < squareOfRounding(here).lanes ? Pack{}.lanes : square.lanes};
    const Pack inverse = only(inverseSquareRoot(known), springs);
    SpringSeries spring(work, block);
    spring.setSeparation(0, separation);
    spring.setSeparation(1, relativeVelocitiesOf(left, here));
    spring.setLength(0, square * inverse);
    spring.setSeparation(kDirection, {separation.x * inverse, separation.y * inverse});
    spring.setLength(kDirection, inverse);
    left = here;
  }
}

/// Returns coefficient n + 2 of the separations of a block. It is computed from the forces of the
/// springs and their neighbours directly, not from the accelerations, because the next order waits
/// for it.
template <Index n>
[[gnu::always_inline]] inline PlaneVector<Pack> separationCoefficient(
    const TaylorWorkspace& work, Index block, const PlaneVector<Pack>& left,
    const PlaneVector<Pack>& here, const PlaneVector<Pack>& right) {
  constexpr double kShare = 1.0 / ((n + 1) * (n + 2));
  const Pack left_inverse_mass =
      kShare * Pack::loadUnaligned(work.chain.inverse_masses + block * kLanes - 1);
  const Pack inverse_mass = kShare * Pack::load(work.chain.inverse_masses + block * kLanes);
  const Pack both = left_inverse_mass + inverse_mass;
  PlaneVector<Pack> result{
      fused(inverse_mass, right.x, fused(left_inverse_mass, left.x, -(both * here.x))),
      fused(inverse_mass, right.y, fused(left_inverse_mass, left.y, -(both * here.y)))};
  if (n == 0 && block == 0) result.y = result.y - only(kShare * work.chain.gravity, 1);
  return result;
}

/// Stores coefficient n of the accelerations of a block.
/// \param right forces of the right neighbours of the springs `here`
template <Index n>
[[gnu::always_inline]] inline void setAccelerations(const TaylorWorkspace& work, Index block,
                                                    const PlaneVector<Pack>& here,
                                                    const PlaneVector<Pack>& right) {
  const Index first = block * kLanes;
  double* accelerations = work.accelerations + n * 2 * work.chain.pitch + first;
  const Pack inverse_mass = Pack::load(work.chain.inverse_masses + first);
  Pack y = (right.y - here.y) * inverse_mass;
  if (n == 0) y = y - only(work.chain.gravity, work.chain.size - 1 - first);
  ((right.x - here.x) * inverse_mass).store(accelerations);
  y.store(accelerations + work.chain.pitch);
}

/// Adds more accelerations to coefficient n of the accelerations and, as differences of neighbours,
/// to coefficient n + 2 of the separations.
/// \param left     that of the first particle
/// \param of_block returns those of the particles of a block
template <typename OfBlock>
[[gnu::always_inline]] inline void addAccelerations(const TaylorWorkspace& work, Index n,
                                                    PlaneVector<Pack> left,
                                                    const OfBlock& of_block) {
  const double share = 1.0 / static_cast<double>((n + 1) * (n + 2));
  for (Index block = 0; block < blocksOf(work.chain.size); ++block) {
    const PlaneVector<Pack> here = of_block(block * kLanes);
    double* x = work.accelerations + n * 2 * work.chain.pitch + block * kLanes;
    double* y = x + work.chain.pitch;
    (Pack::load(x) + here.x).store(x);
    (Pack::load(y) + here.y).store(y);
    if (n + 1 < work.order) {
      SpringSeries spring(work, block);
      const PlaneVector<Pack> separation = spring.separation(n + 2);
      spring.setSeparation(n + 2,
                           {separation.x + share * (here.x - leftNeighbours(left.x, here.x)),
                            separation.y + share * (here.y - leftNeighbours(left.y, here.y))});
    }
    left = here;
  }
}

[[gnu::noinline]] inline void addDrive(const TaylorWorkspace& work) {
  const double* drive = work.chain.drive;
  const PlaneVector<Pack> anchor{work.chain.anchor[0], work.chain.anchor[1]};
  addAccelerations(work, 0, anchor, [&](Index first) {
    return PlaneVector<Pack>{Pack::load(drive + first),
                             Pack::load(drive + work.chain.pitch + first)};
  });
}

/// Adds the drag of the air, -k_air/m times coefficient n of the velocities.
[[gnu::noinline]] inline void addDrag(const TaylorWorkspace& work, const double* state, Index n) {
  const Index pitch = work.chain.pitch;
  // Coefficient n of the velocities is coefficient n - 1 of the accelerations, divided by n.
  const double* velocities = n == 0 ? placeOf(state, pitch, 0).first + 2 * pitch
                                    : work.accelerations + (n - 1) * 2 * pitch;
  const double divisor = n == 0 ? -1.0 : -1.0 / static_cast<double>(n);
  addAccelerations(work, n, {}, [&](Index first) {
    const Pack rate = divisor * Pack::load(work.chain.drag_rates + first);
    return PlaneVector<Pack>{rate * Pack::load(velocities + first),
                             rate * Pack::load(velocities + pitch + first)};
  });
}

/// Computes coefficient n of all accelerations and, if a later order needs it, n + 2 of all
/// separations.
/// \tparam kBlocks number of blocks of a chain that is neither driven nor in air; 0: any
template <Index n, Index kBlocks>
[[gnu::always_inline]] inline void addOrder(const TaylorWorkspace& work, const double* state) {
  const bool wanted = n + 1 < work.order;  // whether another order needs the separations
  const Index blocks = kBlocks > 0 ? kBlocks : blocksOf(work.chain.size);
  PlaneVector<Pack> forces{};
  PlaneVector<Pack> left{};  // forces of their left neighbours
  const auto finish = [&](Index block, const PlaneVector<Pack>& next) {
    const PlaneVector<Pack> right{rightNeighbours(forces.x, next.x),
                                  rightNeighbours(forces.y, next.y)};
    // In this order no store follows the new separations that the compiler could take for a change
    // of them, so a single block keeps them in registers.
    setAccelerations<n>(work, block, forces, right);
    if (wanted)
      SpringSeries(work, block)
          .setSeparation(n + 2, separationCoefficient<n>(work, block, left, forces, right));
  };
  // Descending would save the last call, but long chains then took up to 1.5 times longer.
  for (Index block = 0; block < blocks; ++block) {
    const PlaneVector<Pack> next = springCoefficients<n>(work, SpringSeries(work, block));
    if (block > 0) finish(block - 1, next);
    left = {leftNeighbours(forces.x, next.x), leftNeighbours(forces.y, next.y)};
    forces = next;
  }
  finish(blocks - 1, {});
  if constexpr (kBlocks == 0) {
    if (n == 0 && work.chain.drive != nullptr) addDrive(work);
    if (work.chain.drag_rates != nullptr) addDrag(work, state, n);
  }
}

template <Index kBlocks, Index... n>
void seriesOf(const TaylorWorkspace& work, const double* state,
              std::integer_sequence<Index, n...> /*orders*/) {
  beginSeries(work, state);
  (void)((n < work.order && (addOrder<n, kBlocks>(work, state), true)) && ...);
}

// Local copy of the workspace: through the reference it would be reloaded after every store. A
// chain of one block keeps its coefficients in registers.
void taylorSeries(const TaylorWorkspace& callers_work, const double* state) {
  const TaylorWorkspace work = callers_work;
  constexpr auto kOrders = std::make_integer_sequence<Index, kLargestTaylorOrder>();
  const bool plain = work.chain.drive == nullptr && work.chain.drag_rates == nullptr;
  if (plain && blocksOf(work.chain.size) == 1) return seriesOf<1>(work, state, kOrders);
  seriesOf<0>(work, state, kOrders);
}

}  // namespace
}  // namespace spring_pendulum
