// What is timed: one method of one library (ours included) carrying one chain through time. Peers
// know nothing of this package's types: a problem is plain vectors, so that each of them can be
// compiled with the flags that suit it best.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

/// A chain and its start. States are structures of arrays of 4N numbers: x, y in m, then vx, vy in
/// m/s, each N numbers long.
struct Problem {
  std::string name;
  std::vector<double> masses;  ///< kg; that of the fixed first particle is never used
  std::vector<double> start;   ///< 4N
  double stiffness = 50.0;     ///< N/m
  double damping = 1.0;        ///< N·s/m
  double rest_length = 1.0;    ///< m
  double gravity = 9.81;       ///< m/s²

  std::size_t size() const { return masses.size(); }
};

/// What one call of `Peer::advance` is to do.
struct Run {
  double time_step = 0.01;  ///< s
  std::int64_t steps = 10;  ///< the call moves the state on by steps * time_step
  double tolerance = 0.0;   ///< error-controlled methods; they take steps of their own
  int threads = 1;          ///< ours; no peer has threads. 0: all
  bool energy = false;      ///< ours; whether the dissipated energy is tracked
};

/// A peer that cannot do what it is asked says why.
class PeerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Peer {
 public:
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Back to the start of the problem. Not timed.
  virtual void reset() = 0;
  /// One call as `Run` says. Timed.
  virtual void advance() = 0;
  /// 4N numbers, as `Problem::start`.
  virtual std::vector<double> state() const = 0;
  /// Evaluations of all spring forces since the peer was made.
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
  bool classical_runge_kutta;  ///< takes part in the throughput benchmark
  /// May throw PeerError. Takes all the memory the peer needs; not timed.
  std::function<std::unique_ptr<Peer>(const Problem&, const Run&)> make;
};

/// All that this build has: this package first, then the baselines, then the libraries.
const std::vector<PeerRow>& allPeers();

/// Libraries that this build lacks, for the head of a result.
std::vector<std::string> missingPeers();

}  // namespace spring_pendulum::benchmark
