// The rows that each file of peers adds to the list of all peers.
#pragma once

#include "../peer.hpp"

namespace spring_pendulum::benchmark {

std::vector<PeerRow> ownRows();
std::vector<PeerRow> plainRows();
std::vector<PeerRow> boostRows();
std::vector<PeerRow> gslRows();
std::vector<PeerRow> arkodeRows();
std::vector<PeerRow> cvodeRows();
std::vector<PeerRow> mujocoRows();
std::vector<PeerRow> simbodyRows();
/// Empty if Python finds no SciPy.
std::vector<PeerRow> dop853Rows();

/// A `PeerRow::make` that constructs a `Kind` from problem, run and other arguments.
template <typename Kind, typename... More>
auto makerOf(More... more) {
  return [=](const Problem& problem, const Run& run) -> std::unique_ptr<Peer> {
    return std::make_unique<Kind>(problem, run, more...);
  };
}

}  // namespace spring_pendulum::benchmark
