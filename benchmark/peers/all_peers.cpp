#include <iterator>

#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

struct PeerList {
  std::vector<PeerRow> rows;
  std::vector<std::string> missing;

  void add(std::vector<PeerRow> more) {
    rows.insert(rows.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
  }
};

PeerList makeList() {
  PeerList list;
  list.add(ownRows());
  list.add(plainRows());
#ifdef BENCHMARK_HAS_BOOST
  list.add(boostRows());
#else
  list.missing.emplace_back("Boost.odeint");
#endif
#ifdef BENCHMARK_HAS_GSL
  list.add(gslRows());
#else
  list.missing.emplace_back("GSL");
#endif
#ifdef BENCHMARK_HAS_SUNDIALS
  list.add(arkodeRows());
  list.add(cvodeRows());
#else
  list.missing.emplace_back("SUNDIALS");
#endif
#ifdef BENCHMARK_HAS_MUJOCO
  list.add(mujocoRows());
#else
  list.missing.emplace_back("MuJoCo");
#endif
#ifdef BENCHMARK_HAS_SIMBODY
  list.add(simbodyRows());
#else
  list.missing.emplace_back("Simbody");
#endif
  return list;
}

const PeerList& theList() {
  static const PeerList kList = makeList();
  return kList;
}

}  // namespace

const std::vector<PeerRow>& allPeers() {
  return theList().rows;
}

const std::vector<std::string>& missingPeers() {
  return theList().missing;
}

}  // namespace spring_pendulum::benchmark
