// Runs cases and makes their rows.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "sweep/study/columns.hpp"
#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// What cases must have in common to share a reference run, as text; empty if a case has none to
/// share.
std::string sceneOf(const Study& study, const Case& a_case);

/// The shared reference runs of one process. Keeps those that were used last; a scene that comes again
/// later gets the same reference run, computed again.
class References {
 public:
  /// \param most number of reference runs to keep, at least the number of threads
  explicit References(std::size_t most) : most_(most) {}

  /// Returns the reference run of a scene.
  std::shared_ptr<SharedReference> take(std::int32_t scene, const Case& a_case);

 private:
  struct Scene {
    std::int32_t number;
    std::shared_ptr<SharedReference> reference;
  };

  std::size_t most_;
  std::mutex mutex_;
  std::list<Scene> scenes_;  ///< the last used first
};

/// The header of the table.
std::string tableHeader(const Study& study);
/// The beginning of a row: number and values of the case.
std::string rowStart(const Study& study, std::int64_t index);

/// Runs a case.
/// \returns the columns as comma-separated text; nothing if `stop` has stopped the run
/// \throws std::runtime_error naming the case
std::optional<std::string> runCase(const WantedColumns& columns, const Case& a_case,
                                   std::shared_ptr<SharedReference> reference,
                                   const std::function<bool()>& stop);

}  // namespace spring_pendulum::sweep
