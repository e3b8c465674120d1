#include "mpi/chain_part.hpp"

#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "integration/work.hpp"
#include "model/block_sums.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace spring_pendulum {
namespace {

/// Numbers per block of springs: three energies and the dissipated energy.
constexpr std::size_t kSums = 4;

void checkBorder(const Scenario& scenario, const Part& part, int ranks, std::ptrdiff_t border) {
  if (ranks == 1 || part.last - part.first >= 2 * border) return;
  throw InputError(
      fmt::format("{} on {} ranks leave a rank {}, but each needs {}, twice the steps per frame "
                  "times the stages of "
                  "{}; use fewer ranks or fewer steps_per_frame",
                  counted(part.particles, "particle"), ranks, part.last - part.first, 2 * border,
                  scenario.method.get().name));
}

std::ptrdiff_t borderOf(const Scenario& scenario, std::int64_t particles) {
  const std::int64_t stages = scenario.method.get().stages;
  // The second term keeps the product small; such a border is refused, or not needed by one rank.
  return std::min(scenario.steps_per_frame, particles + 1) * stages + 1;
}

}  // namespace

FixedStepIntegrator& ChainPart::Piece::fixedStep() const {
  return dynamic_cast<FixedStepIntegrator&>(*integrator);
}

bool ChainPart::Piece::advance(double time_step, std::int64_t steps,
                               const std::function<bool()>& stop) {
  // Velocity-Verlet keeps accelerations, which are wrong at the ends of a piece. It keeps them only
  // without damping, and then there is no dissipated energy that this could reset.
  if (chain.spring().damping == 0.0) integrator->restart();
  while (steps > 0) {
    if (stop()) return false;
    steps -=
        integrator->advanceWithin(state, time_step, steps, integrator->work() + kWorkBetweenStops);
  }
  return true;
}

ChainPart::ChainPart(const Ranks& ranks, const Scenario& scenario, const Part& part,
                     bool track_dissipation)
    : ranks_(ranks),
      scenario_(scenario),
      track_dissipation_(track_dissipation),
      part_{part.particles, part.first, part.last, {}},
      border_(borderOf(scenario, part.particles)),
      own_(makePiece(
          part.own.masses, part.own.state,
          scenario.threads > 0
              ? scenario.threads
              : std::max<std::int64_t>(1, std::thread::hardware_concurrency() /
                                              static_cast<unsigned>(ranks.onThisMachine())))) {
  ranks.together([&] {
    checkBorder(scenario, part_, ranks.size(), border_);
    own_.fixedStep();
  });
  height_ = own_.state.y()[0];
  ranks.shareFromFirst(&height_, 1);
  addStrips();
}

ChainPart::Piece ChainPart::makePiece(const AlignedNumbers& masses, const State& state,
                                      std::int64_t threads) const {
  Piece piece{scenario_.chainOf(masses), state, nullptr};
  piece.integrator = makeIntegrator(scenario_.method, piece.chain,
                                    {scenario_.tolerance, track_dissipation_,
                                     static_cast<int>(std::min<std::int64_t>(threads, 1024))});
  return piece;
}

ChainPart::Strip::Strip(const ChainPart& part, bool right)
    : neighbour(part.ranks_.rank() + (right ? 1 : -1)),
      outgoing(part.border_, 4),
      incoming(part.border_, 4),
      piece{part.own_.chain, State(), nullptr} {
  const std::ptrdiff_t end = part.part_.last - part.part_.first;  // the last row of the part
  const std::ptrdiff_t border = part.border_;
  sent = right ? end - border : 1;
  copied = right ? end - 2 * border : 0;
  copy_at = right ? 0 : border;
  halo_at = right ? 2 * border + 1 : 0;
  results = right ? end - border + 1 : 0;
  result_at = results - copied + copy_at;
  springs = right ? end - border : 0;
}

void ChainPart::addStrips() {
  if (!ranks_.isFirst()) strips_.emplace_back(*this, false);
  if (!ranks_.isLast()) strips_.emplace_back(*this, true);
  for (Strip& strip : strips_) {
    strip.outgoing.col(0) = own_.chain.masses().segment(strip.sent, border_);
  }
  std::vector<MPI_Request> requests = exchange(border_);
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (Strip& strip : strips_) {
    AlignedNumbers masses(3 * border_ + 1);
    masses.view().segment(strip.copy_at, 2 * border_ + 1) =
        own_.chain.masses().segment(strip.copied, 2 * border_ + 1);
    masses.view().segment(strip.halo_at, border_) = strip.incoming.col(0);
    strip.piece = makePiece(masses, State(masses.size()), 1);
  }
}

std::vector<MPI_Request> ChainPart::exchange(std::ptrdiff_t count) {
  std::vector<MPI_Request> requests;
  const int numbers = static_cast<int>(count);
  for (Strip& strip : strips_) {
    MPI_Irecv(strip.incoming.data(), numbers, MPI_DOUBLE, strip.neighbour, 0, MPI_COMM_WORLD,
              &requests.emplace_back());
    MPI_Isend(strip.outgoing.data(), numbers, MPI_DOUBLE, strip.neighbour, 0, MPI_COMM_WORLD,
              &requests.emplace_back());
  }
  return requests;
}

bool ChainPart::advance(double time_step, std::int64_t steps, const std::function<bool()>& stop) {
  for (Strip& strip : strips_) {
    strip.outgoing = own_.state.values().middleRows(strip.sent, border_);
    strip.piece.state.values().middleRows(strip.copy_at, 2 * border_ + 1) =
        own_.state.values().middleRows(strip.copied, 2 * border_ + 1);
  }
  std::vector<MPI_Request> requests;
  {
    const Stopwatch stopwatch(seconds_exchanging_);
    requests = exchange(4 * border_);
  }
  bool complete = own_.advance(time_step, steps, stop);
  {
    const Stopwatch stopwatch(seconds_exchanging_);
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  }
  for (Strip& strip : strips_) {
    complete = complete && finishStrip(strip, time_step, steps, stop);
  }
  return complete;
}

bool ChainPart::finishStrip(Strip& strip, double time_step, std::int64_t steps,
                            const std::function<bool()>& stop) {
  strip.piece.state.values().middleRows(strip.halo_at, border_) = strip.incoming;
  if (!strip.piece.advance(time_step, steps, stop)) return false;
  own_.state.values().middleRows(strip.results, border_) =
      strip.piece.state.values().middleRows(strip.result_at, border_);
  if (!track_dissipation_) return true;
  std::copy_n(strip.piece.fixedStep().dissipated().data() + border_, border_,
              own_.fixedStep().dissipated().data() + strip.springs);
  return true;
}

ChainPart::Totals ChainPart::totals() const {
  const Stopwatch stopwatch(seconds_summing_);
  const DissipatedEnergy& dissipated = own_.fixedStep().dissipated();
  const std::ptrdiff_t block = sumBlockSize(part_.particles - 1);
  const std::ptrdiff_t springs = part_.last - part_.first;
  std::vector<double> sums;
  sums.reserve(kSums * static_cast<std::size_t>(springs / block + 1));
  for (std::ptrdiff_t first = 0; first < springs; first += block) {
    const std::ptrdiff_t last = std::min(springs, first + block);
    const Energy energy = energyOfSprings(own_.chain, own_.state, first, last, height_);
    sums.insert(sums.end(), {energy.kinetic, energy.gravity, energy.spring,
                             track_dissipation_ ? dissipated.sum(first, last) : 0.0});
  }
  sums = ranks_.gather(sums);
  double totals[kSums] = {};
  for (std::size_t i = 0; i < sums.size(); ++i) totals[i % kSums] += sums[i];
  ranks_.shareFromFirst(totals, kSums);
  return {{totals[0], totals[1], totals[2]}, totals[3]};
}

EnergyScaleSums ChainPart::scaleSums() const {
  double numbers[3] = {};
  if (!ranks_.isLast()) {
    MPI_Recv(numbers, 3, MPI_DOUBLE, ranks_.rank() + 1, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  EnergyScaleSums sums{numbers[0], numbers[1], numbers[2]};
  sums.add(own_.chain, own_.state);
  if (!ranks_.isFirst()) {
    const double sent[3] = {sums.weight, sums.depth, sums.least};
    MPI_Send(sent, 3, MPI_DOUBLE, ranks_.rank() - 1, 0, MPI_COMM_WORLD);
  }
  ranks_.shareFromFirst(&sums, 1);
  return sums;
}

}  // namespace spring_pendulum
