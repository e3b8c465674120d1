// Kernels of the Taylor series method. The recursion is derived in taylor_stepper.hpp; u, L, d and T
// below are the quantities of that derivation.
#pragma once

#include "integration/kernels/block.hpp"
#include "integration/kernels/largest.hpp"
#include "integration/kernels/pack.hpp"
#include "integration/kernels/taylor_workspace.hpp"
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>

namespace spring_pendulum {
namespace {

using Index = std::ptrdiff_t;
constexpr Index kGroup = 8;  ///< springs whose coefficients lie together, on all instruction sets

/// A coefficient of a spring: of its separation and its length.
struct SpringCoefficient {
  PlaneVector<Pack> separation;
  Pack length;
};

/// What is missing to coefficients of one order: of sum_j a_j b_{n-j} the terms known so far.
struct Convolutions {
  SpringCoefficient product;  ///< of L_{n+1}, times L_0: three sums, for a shorter latency
  Pack quotient;              ///< of u L
  PlaneVector<Pack> force;    ///< of u d

  Pack length() const { return (product.separation.x + product.separation.y) - product.length; }
};

/// The coefficients of the springs of one block.
class SpringSeries {
 public:
  SpringSeries(const TaylorWorkspace& work, Index block)
      : first_(work.springs +
               block * kLanes / kGroup * TaylorWorkspace::springRows(work.order) * kRow +
               block * kLanes % kGroup),
        order_(work.order) {}

  PlaneVector<Pack> separation(Index n) const { return {at(n, 0), at(n, 1)}; }
  Pack length(Index n) const { return at(n, 2); }
  Pack quotient(Index n) const { return at(n, 3); }
  PlaneVector<Pack> direction() const { return separation(order_ + 1); }
  Pack inverseLength() const { return at(order_ + 1, 2); }
  Convolutions convolutions() const {
    return {{{length(order_ + 2), Pack{}}, Pack{}}, quotient(order_ + 2), separation(order_ + 2)};
  }

  void setSeparation(Index n, const PlaneVector<Pack>& value) {
    value.x.store(row(n));
    value.y.store(row(n) + kGroup);
  }
  void setLength(Index n, Pack value) { value.store(row(n) + 2 * kGroup); }
  void setQuotient(Index n, Pack value) { value.store(row(n) + 3 * kGroup); }
  void setDirection(const PlaneVector<Pack>& value) { setSeparation(order_ + 1, value); }
  void setInverseLength(Pack value) { setLength(order_ + 1, value); }
  void setConvolutions(const Convolutions& value) {
    setSeparation(order_ + 2, value.force);
    setLength(order_ + 2, value.length());
    setQuotient(order_ + 2, value.quotient);
  }

 private:
  static constexpr Index kRow = 4 * kGroup;
  double* row(Index n) const { return first_ + n * kRow; }
  Pack at(Index n, Index quantity) const { return Pack::load(row(n) + quantity * kGroup); }

  double* first_;
  Index order_;
};

[[gnu::always_inline]] inline SpringCoefficient coefficient(const SpringSeries& spring, Index n) {
  return {spring.separation(n), spring.length(n)};
}

/// The terms of two coefficients in the convolutions for the length.
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

[[gnu::always_inline]] inline void addTerm(Convolutions& sums, Pack quotient,
                                           const SpringCoefficient& other) {
  sums.quotient = fused(quotient, other.length, sums.quotient);
  sums.force.x = fused(quotient, other.separation.x, sums.force.x);
  sums.force.y = fused(quotient, other.separation.y, sums.force.y);
}

/// Of the even order n and of the next one, what the coefficients before n give: the loads are
/// shared, and there is twice as much to do side by side.
[[gnu::always_inline]] inline void addKnownTerms(const SpringSeries& spring, Index n,
                                                 Convolutions& here, Convolutions& next) {
  if (n == 0) return;
  SpringCoefficient last = coefficient(spring, n);
  const SpringCoefficient first = coefficient(spring, 1);
  addProduct(here, first, last);
  for (Index j = 2; 2 * j <= n; ++j) {
    const SpringCoefficient a = coefficient(spring, j);
    addProduct(next, a, last);
    last = coefficient(spring, n + 1 - j);
    addProduct(here, a, last);
  }
  const SpringCoefficient middle = coefficient(spring, n / 2 + 1);
  addProduct(next, half(middle), middle);

  last = coefficient(spring, n);
  addTerm(here, spring.quotient(0), last);
  for (Index j = 1; j < n; ++j) {
    const Pack quotient = spring.quotient(j);
    addTerm(next, quotient, last);
    last = coefficient(spring, n - j);
    addTerm(here, quotient, last);
  }
}

/// What order n adds to the sums of order n + 1.
[[gnu::always_inline]] inline void addNewTerms(const SpringSeries& spring, Index n,
                                               Convolutions& next) {
  const SpringCoefficient first = coefficient(spring, 1);
  const SpringCoefficient newest = coefficient(spring, n + 1);
  addProduct(next, n == 0 ? half(first) : first, newest);
  addTerm(next, spring.quotient(0), newest);
  if (n > 0) addTerm(next, spring.quotient(n), first);
}

/// L_{n+1}, u_n and the force coefficient n of the springs of one block; d_0 to d_{n+1} are known.
[[gnu::always_inline]] inline PlaneVector<Pack> springCoefficients(const TaylorWorkspace& work,
                                                                   SpringSeries spring, Index n,
                                                                   const Convolutions& sums) {
  const Pack inverse_length = spring.inverseLength();
  const PlaneVector<Pack> direction = spring.direction();
  const PlaneVector<Pack> newest = spring.separation(n + 1);
  const Pack length =
      fused(direction.x, newest.x, fused(direction.y, newest.y, sums.length() * inverse_length));
  spring.setLength(n + 1, length);

  const Pack stretch = n == 0 ? spring.length(0) - work.spring.rest_length : spring.length(n);
  const Pack elastic = fused(work.spring.stiffness, stretch, -sums.quotient) * inverse_length;
  const Pack damping = (work.spring.damping * static_cast<double>(n + 1)) * inverse_length;
  const Pack quotient = fused(damping, length, elastic);
  spring.setQuotient(n, quotient);
  const PlaneVector<Pack> origin = spring.separation(0);
  return {fused(quotient, origin.x, sums.force.x), fused(quotient, origin.y, sums.force.y)};
}

/// The same, with the sums of even orders made here, those of odd orders on the way.
template <bool kEven>
[[gnu::always_inline]] inline PlaneVector<Pack> springCoefficients(const TaylorWorkspace& work,
                                                                   SpringSeries spring, Index n) {
  if constexpr (kEven) {
    Convolutions here{};
    Convolutions next{};
    addKnownTerms(spring, n, here, next);
    const PlaneVector<Pack> force = springCoefficients(work, spring, n, here);
    addNewTerms(spring, n, next);
    spring.setConvolutions(next);
    return force;
  } else {
    return springCoefficients(work, spring, n, spring.convolutions());
  }
}

/// From the state: d_0, d_1 = w, L_0 and what is divided by it.
inline void beginSeries(const TaylorWorkspace& work, const double* state) {
  const Index blocks = blocksOf(work.size);
  Block here = load({state, work.pitch});
  for (Index block = 0; block < blocks; ++block) {
    const Block next = block + 1 < blocks ? load({state + (block + 1) * kLanes, work.pitch}) : here;
    const PlaneVector<Pack> separation{rightNeighbours(here.x, next.x) - here.x,
                                       rightNeighbours(here.y, next.y) - here.y};
    const Pack square = squaredLength(separation);
    // Behind the chain's end 1/L_0 = 0, so nothing comes of the other numbers there.
    const Index springs = work.size - 1 - block * kLanes;
    const Pack inverse = only(inverseSquareRoot(square), 0, springs);
    SpringSeries spring(work, block);
    spring.setSeparation(0, separation);
    spring.setSeparation(1, {rightNeighbours(here.vx, next.vx) - here.vx,
                             rightNeighbours(here.vy, next.vy) - here.vy});
    spring.setLength(0, square * inverse);
    spring.setDirection({separation.x * inverse, separation.y * inverse});
    spring.setInverseLength(inverse);
    here = next;
  }
}

/// Coefficient n of all accelerations, and n + 2 of all separations.
template <bool kEven>
void addOrder(const TaylorWorkspace& work, Index n) {
  const double share = 1.0 / (static_cast<double>(n + 1) * static_cast<double>(n + 2));
  const auto differ = [share](const PlaneVector<Pack>& here, const PlaneVector<Pack>& next) {
    return PlaneVector<Pack>{share * (rightNeighbours(here.x, next.x) - here.x),
                             share * (rightNeighbours(here.y, next.y) - here.y)};
  };
  const bool wanted = n + 1 < work.order;  // nothing is made of the last separations
  const Index blocks = blocksOf(work.size);
  double* accelerations = work.accelerations + n * 2 * work.pitch;
  PlaneVector<Pack> left{};      // forces of the block before
  PlaneVector<Pack> previous{};  // its accelerations
  for (Index block = 0; block < blocks; ++block) {
    const Index first = block * kLanes;
    const PlaneVector<Pack> right = springCoefficients<kEven>(work, SpringSeries(work, block), n);
    const Pack inverse_mass = Pack::load(work.inverse_masses + first);
    PlaneVector<Pack> here{(right.x - leftNeighbours(left.x, right.x)) * inverse_mass,
                           (right.y - leftNeighbours(left.y, right.y)) * inverse_mass};
    if (n == 0) {
      here.y = here.y - only(Pack::all(work.gravity), block == 0 ? 1 : 0, work.size - first);
    }
    here.x.store(accelerations + first);
    here.y.store(accelerations + work.pitch + first);
    if (block > 0 && wanted) {
      SpringSeries(work, block - 1).setSeparation(n + 2, differ(previous, here));
    }
    left = right;
    previous = here;
  }
  if (wanted) SpringSeries(work, blocks - 1).setSeparation(n + 2, differ(previous, previous));
}

// The workspace is copied: of the caller's the compiler must assume that it changes with every
// number that is written.
void taylorSeries(const TaylorWorkspace& callers_work, const double* state) {
  const TaylorWorkspace work = callers_work;
  beginSeries(work, state);
  for (Index n = 0; n < work.order; n += 2) {
    addOrder<true>(work, n);
    if (n + 1 < work.order) addOrder<false>(work, n + 1);
  }
}

/// The weighted sum of the accelerations' coefficients of one block.
[[gnu::always_inline]] inline Block weightedSum(const TaylorWorkspace& work,
                                                const TaylorWeights& weights, Index block) {
  Block change{};
  for (Index n = weights.count - 1; n >= 0; --n) {
    const double* row = work.accelerations + n * 2 * work.pitch + block * kLanes;
    const Pack x = Pack::load(row);
    const Pack y = Pack::load(row + work.pitch);
    const double position = weights.position[n];
    const double velocity = weights.velocity[n];
    change = {fused(position, x, change.x), fused(position, y, change.y),
              fused(velocity, x, change.vx), fused(velocity, y, change.vy)};
  }
  return change;
}

void taylorState(const TaylorWorkspace& callers_work, const double* state, const double* base,
                 const TaylorWeights& weights, double* out) {
  const TaylorWorkspace work = callers_work;
  const double time = weights.start_velocity;
  for (Index block = 0; block < blocksOf(work.size); ++block) {
    const Block change = weightedSum(work, weights, block);
    const Block speed = load({state + block * kLanes, work.pitch});
    const Block from = load({base + block * kLanes, work.pitch});
    store({from.x + fused(time, speed.vx, change.x), from.y + fused(time, speed.vy, change.y),
           from.vx + change.vx, from.vy + change.vy},
          {out + block * kLanes, work.pitch});
  }
}

LargestChange taylorLargestSum(const TaylorWorkspace& work, const TaylorWeights& weights) {
  Largest position;
  Largest velocity;
  for (Index block = 0; block < blocksOf(work.size); ++block) {
    const Block change = weightedSum(work, weights, block);
    position.add(change.x);
    position.add(change.y);
    velocity.add(change.vx);
    velocity.add(change.vy);
  }
  return {position.result(), velocity.result()};
}

double taylorLargest(const TaylorWorkspace& work, std::ptrdiff_t n) {
  Largest largest;
  const double* row = work.accelerations + n * 2 * work.pitch;
  for (Index block = 0; block < blocksOf(work.size); ++block) {
    largest.add(Pack::load(row + block * kLanes));
    largest.add(Pack::load(row + work.pitch + block * kLanes));
  }
  return largest.result();
}

}  // namespace
}  // namespace spring_pendulum
