// The part of a chain that a rank integrates.
//
// Information travels one particle per stage, so S steps of s stages need a border of S·s + 1 particles
// of each neighbour. A rank sends its borders once per frame, integrates its own part as a chain with
// free ends meanwhile, and then integrates a strip of three borders at each end, whose middle gives the
// particles that the first chain got wrong. Every particle sees the arithmetic of a single chain, see
// explicit_runge_kutta.hpp.
#pragma once

#include "integration/fixed_step/fixed_step_integrator.hpp"
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/simulation/energy_balance.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "mpi/part_file.hpp"
#include "mpi/ranks.hpp"

namespace spring_pendulum {

class ChainPart {
 public:
  /// All ranks call the constructor and the functions.
  /// \throws RankFailure if the method has no border, or a part is shorter than two borders
  ChainPart(const Ranks& ranks, const Scenario& scenario, const Part& part, bool track_dissipation);

  /// \param stop asked every few milliseconds whether to give up; another rank may still complete
  /// \returns false if `stop` returned true; the state is of no use then
  bool advance(double time_step, std::int64_t steps, const std::function<bool()>& stop);

  /// Energy of the whole chain, and the energy dissipated so far, J.
  struct Totals {
    Energy energy;
    double dissipated = 0.0;
  };
  Totals totals() const;
  EnergyScaleSums scaleSums() const;

  /// The particles of this rank; the first row belongs to the rank to the left, or is P_1.
  const Chain& chain() const { return own_.chain; }
  const State& state() const { return own_.state; }
  std::int64_t particles() const { return part_.particles; }
  /// The first row that this rank writes: P_1 belongs to the first rank.
  std::ptrdiff_t firstRow() const { return ranks_.isFirst() ? 0 : 1; }

  /// Wall-clock time, s.
  double secondsExchanging() const { return seconds_exchanging_; }
  double secondsSumming() const { return seconds_summing_; }

 private:
  /// Particles that are integrated as a chain of their own.
  struct Piece {
    Chain chain;
    State state;
    std::unique_ptr<Integrator> integrator;

    FixedStepIntegrator& fixedStep() const;
    bool advance(double time_step, std::int64_t steps, const std::function<bool()>& stop);
  };
  /// The piece at an end of the part, and where its rows come from and go to.
  struct Strip {
    Strip(const ChainPart& part, bool right);

    int neighbour;
    std::ptrdiff_t sent;       ///< first of the rows of the part that are sent
    std::ptrdiff_t copied;     ///< first of the rows of the part that are copied
    std::ptrdiff_t copy_at;    ///< the first copied row in the strip
    std::ptrdiff_t halo_at;    ///< the first received row in the strip
    std::ptrdiff_t results;    ///< first of the rows of the part that the strip computes
    std::ptrdiff_t result_at;  ///< this row in the strip
    std::ptrdiff_t springs;    ///< first of the springs of the part that the strip computes
    State::Matrix outgoing;
    State::Matrix incoming;
    Piece piece;
  };

  Piece makePiece(const AlignedNumbers& masses, const State& state, std::int64_t threads) const;
  void addStrips();
  /// Starts to exchange `count` numbers of `outgoing` and `incoming` of each strip.
  std::vector<MPI_Request> exchange(std::ptrdiff_t count);
  bool finishStrip(Strip& strip, double time_step, std::int64_t steps,
                   const std::function<bool()>& stop);

  const Ranks& ranks_;
  const Scenario& scenario_;
  bool track_dissipation_;
  Part part_;  ///< without its particles
  std::ptrdiff_t border_;
  double height_ = 0.0;  ///< y of P_1, m
  Piece own_;
  std::vector<Strip> strips_;
  double seconds_exchanging_ = 0.0;
  mutable double seconds_summing_ = 0.0;
};

}  // namespace spring_pendulum
