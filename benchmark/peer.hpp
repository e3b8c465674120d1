// The interface of timed methods: one method of one library, this package included, integrates one
// chain. A problem consists of plain vectors instead of types of this package, so that each peer
// can be compiled with the flags that suit it best.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

/// A chain and its start. A state is a structure of arrays of 4N numbers: x, y in m, then vx, vy in
/// m/s, N numbers each.
struct Problem {
  std::string name;
  std::vector<double> masses;  ///< kg; the mass of the first, fixed particle is not used
  std::vector<double> start;   ///< 4N
  double stiffness = 50.0;     ///< N/m
  double damping = 1.0;        ///< N·s/m
  double rest_length = 1.0;    ///< m
  double gravity = 9.81;       ///< m/s²

  std::size_t size() const { return masses.size(); }
};

/// The work of one call of `Peer::advance`.
struct Run {
  double time_step = 0.01;  ///< s
  std::int64_t steps = 10;  ///< a call advances the state by steps * time_step
  double tolerance = 0.0;   ///< m, only for error-controlled methods, which choose their own steps
  int threads = 1;          ///< only for this package; 0: one per processor core
  bool energy = false;      ///< only for this package: whether to track the dissipated energy
};

/// Thrown by a peer that does not support a run, with the reason.
class PeerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Peer {
 public:
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Returns to the start of the problem. Not timed.
  virtual void reset() = 0;
  /// Takes the steps of `Run`. Timed.
  virtual void advance() = 0;
  /// 4N numbers, like `Problem::start`.
  virtual std::vector<double> state() const = 0;
  /// Evaluations of all spring forces since construction.
  virtual std::int64_t forceEvaluations() const = 0;

 protected:
  Peer() = default;
};

enum class Stepping { kFixed, kErrorControlled };

/// One row of the list of all peers.
struct PeerRow {
  std::string library;  ///< "own" for this package, "plain" for the two baselines
  std::string name;     ///< unique, as plots and tables show it
  Stepping stepping;
  bool classical_runge_kutta;  ///< whether it takes part in the throughput benchmark
  /// Constructs the peer with all its memory. Not timed. May throw PeerError.
  std::function<std::unique_ptr<Peer>(const Problem&, const Run&)> make;
};

/// All peers of this build: this package, the baselines, then the libraries.
const std::vector<PeerRow>& allPeers();

/// Names of libraries that this build lacks, for the head of a result file.
std::vector<std::string> missingPeers();

}  // namespace spring_pendulum::benchmark
