#include <algorithm>
#include <iterator>

#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

std::vector<PeerRow> makeList() {
  std::vector<PeerRow> list;
  const auto add = [&list](std::vector<PeerRow> rows) {
    std::move(rows.begin(), rows.end(), std::back_inserter(list));
  };
  add(ownRows());
  add(plainRows());
#ifdef BENCHMARK_HAS_BOOST
  add(boostRows());
#endif
#ifdef BENCHMARK_HAS_GSL
  add(gslRows());
#endif
#ifdef BENCHMARK_HAS_SUNDIALS
  add(arkodeRows());
  add(cvodeRows());
#endif
#ifdef BENCHMARK_HAS_MUJOCO
  add(mujocoRows());
#endif
#ifdef BENCHMARK_HAS_SIMBODY
  add(simbodyRows());
#endif
#ifdef BENCHMARK_HAS_PYTHON
  add(dop853Rows());
#endif
  return list;
}

}  // namespace

const std::vector<PeerRow>& allPeers() {
  static const std::vector<PeerRow> kList = makeList();
  return kList;
}

std::vector<std::string> missingPeers() {
  std::vector<std::string> missing{"Boost.odeint", "GSL", "SUNDIALS", "MuJoCo", "Simbody", "SciPy"};
  for (const PeerRow& row : allPeers()) {
    missing.erase(std::remove(missing.begin(), missing.end(), row.library), missing.end());
  }
  return missing;
}

}  // namespace spring_pendulum::benchmark
