// Kernels of the Taylor series method. The recursion is derived in taylor_series.hpp; u, L, d and T
// below are the quantities of that derivation.
#pragma once

#include <spring_pendulum/integration/taylor_workspace.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <array>
#include <cstddef>

#include "block.hpp"
#include "largest.hpp"
#include "pack.hpp"

namespace spring_pendulum {
namespace {

using Index = std::ptrdiff_t;
constexpr Index kGroup = 8;  ///< springs whose coefficients lie together, on all instruction sets

/// The coefficients of the springs of one block.
class SpringSeries {
 public:
  SpringSeries(const TaylorWorkspace& work, Index block)
      : first_(work.springs + block * kLanes / kGroup * (work.order + 2) * kRow +
               block * kLanes % kGroup),
        order_(work.order) {}

  PlaneVector<Pack> separation(Index n) const { return {at(n, 0), at(n, 1)}; }
  Pack length(Index n) const { return at(n, 2); }
  Pack quotient(Index n) const { return at(n, 3); }
  PlaneVector<Pack> direction() const { return separation(order_ + 1); }
  Pack inverseLength() const { return at(order_ + 1, 2); }

  void setSeparation(Index n, const PlaneVector<Pack>& value) {
    value.x.store(row(n));
    value.y.store(row(n) + kGroup);
  }
  void setLength(Index n, Pack value) { value.store(row(n) + 2 * kGroup); }
  void setQuotient(Index n, Pack value) { value.store(row(n) + 3 * kGroup); }
  void setDirection(const PlaneVector<Pack>& value) { setSeparation(order_ + 1, value); }
  void setInverseLength(Pack value) { setLength(order_ + 1, value); }

 private:
  static constexpr Index kRow = 4 * kGroup;
  double* row(Index n) const { return first_ + n * kRow; }
  Pack at(Index n, Index quantity) const { return Pack::load(row(n) + quantity * kGroup); }

  double* first_;
  Index order_;
};

/// What is missing to L_0 L_{n+1} = d_0·d_{n+1} + (this).
[[gnu::always_inline]] inline Pack lengthConvolution(const SpringSeries& spring, Index n) {
  const auto product = [&spring](Index i, Index j) {
    const PlaneVector<Pack> a = spring.separation(i);
    const PlaneVector<Pack> b = spring.separation(j);
    return a.x * b.x + a.y * b.y - spring.length(i) * spring.length(j);
  };
  Pack sum;
  for (Index j = 1; 2 * j < n + 1; ++j) sum = sum + product(j, n + 1 - j);
  if (n % 2 == 1) sum = sum + 0.5 * product((n + 1) / 2, (n + 1) / 2);
  return sum;
}

/// L_{n+1}, u_n and the force coefficient n of the springs of one block; d_0 to d_{n+1} are known.
[[gnu::always_inline]] inline PlaneVector<Pack> springCoefficients(const TaylorWorkspace& work,
                                                                   SpringSeries spring, Index n) {
  const Pack length_sum = lengthConvolution(spring, n);
  Pack quotient_sum;
  PlaneVector<Pack> force;
  for (Index j = 0; j < n; ++j) {
    const Pack quotient = spring.quotient(j);
    const PlaneVector<Pack> separation = spring.separation(n - j);
    quotient_sum = quotient_sum + quotient * spring.length(n - j);
    force.x = force.x + quotient * separation.x;
    force.y = force.y + quotient * separation.y;
  }
  const Pack inverse_length = spring.inverseLength();
  const PlaneVector<Pack> direction = spring.direction();
  const PlaneVector<Pack> newest = spring.separation(n + 1);
  const Pack length = direction.x * newest.x + direction.y * newest.y + length_sum * inverse_length;
  spring.setLength(n + 1, length);

  const Pack stretch = n == 0 ? spring.length(0) - work.spring.rest_length : spring.length(n);
  const Pack elastic = (work.spring.stiffness * stretch - quotient_sum) * inverse_length;
  const Pack damping = (work.spring.damping * static_cast<double>(n + 1)) * inverse_length;
  const Pack quotient = elastic + damping * length;
  spring.setQuotient(n, quotient);
  const PlaneVector<Pack> origin = spring.separation(0);
  return {force.x + quotient * origin.x, force.y + quotient * origin.y};
}

/// From the state: d_0, d_1 = w, L_0 and what is divided by it.
inline void beginSeries(const TaylorWorkspace& work, const double* state) {
  const Index blocks = blocksOf(work.size);
  Block here = load({state, work.pitch});
  for (Index block = 0; block < blocks; ++block) {
    const Block next = block + 1 < blocks ? load({state + (block + 1) * kLanes, work.pitch}) : here;
    const PlaneVector<Pack> separation{rightNeighbours(here.x, next.x) - here.x,
                                       rightNeighbours(here.y, next.y) - here.y};
    const Pack square = separation.x * separation.x + separation.y * separation.y;
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
inline void addOrder(const TaylorWorkspace& work, Index n) {
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
    const PlaneVector<Pack> right = springCoefficients(work, SpringSeries(work, block), n);
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

void taylorSeries(const TaylorWorkspace& work, const double* state) {
  beginSeries(work, state);
  for (Index n = 0; n < work.order; ++n) addOrder(work, n);
}

void taylorState(const TaylorWorkspace& work, const double* state, double time, double* out) {
  std::array<double, kLargestTaylorOrder> for_velocity{};
  std::array<double, kLargestTaylorOrder> for_position{};
  double power = time;
  for (Index n = 0; n < work.order; ++n) {
    const auto i = static_cast<std::size_t>(n);
    for_velocity[i] = power / static_cast<double>(n + 1);
    power *= time;
    for_position[i] = power / (static_cast<double>(n + 1) * static_cast<double>(n + 2));
  }
  for (Index block = 0; block < blocksOf(work.size); ++block) {
    Block change{};
    for (Index n = work.order - 1; n >= 0; --n) {
      const double* row = work.accelerations + n * 2 * work.pitch + block * kLanes;
      const Pack x = Pack::load(row);
      const Pack y = Pack::load(row + work.pitch);
      const auto i = static_cast<std::size_t>(n);
      change = {change.x + for_position[i] * x, change.y + for_position[i] * y,
                change.vx + for_velocity[i] * x, change.vy + for_velocity[i] * y};
    }
    const Block from = load({state + block * kLanes, work.pitch});
    store({from.x + (time * from.vx + change.x), from.y + (time * from.vy + change.y),
           from.vx + change.vx, from.vy + change.vy},
          {out + block * kLanes, work.pitch});
  }
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

double taylorLengthChange(const TaylorWorkspace& work, double time) {
  Largest largest;
  for (Index block = 0; block < blocksOf(work.size); ++block) {
    const SpringSeries spring(work, block);
    Pack change = time * spring.length(work.order);
    for (Index n = work.order - 1; n > 0; --n) change = time * (spring.length(n) + change);
    largest.add(change * spring.inverseLength());
  }
  return largest.result();
}

}  // namespace
}  // namespace spring_pendulum
