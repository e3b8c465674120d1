// Messages that repeat what acted on a run from outside.
#pragma once

#include <spring_pendulum/PendulumInput.h>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <ros/time.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace spring_pendulum {

/// Numbers the changes of a run and hands them on as messages.
class InputLog {
 public:
  using Sink = std::function<void(const PendulumInput&)>;

  /// \param display_interval of the run, s
  /// \param began            the present time, which tells the runs in a bag apart
  InputLog(double display_interval, ros::Time began, Sink sink)
      : display_interval_(display_interval), began_(began), sink_(std::move(sink)) {}

  /// Must be called at the start of a run, and whenever it has gone to a frame, with the time until then, s.
  void started(const Run& run, double time);
  /// Must be called after every Run::change.
  /// \param before the state until then
  /// \param time   at it, s: another method may round it differently
  void changed(const Run& run, const State& before, double time);
  void ended(const Run& run);  ///< must be called at the end of the node

 private:
  PendulumInput messageOf(const Run& run, double time);

  double display_interval_;
  ros::Time began_;
  Sink sink_;
  std::uint32_t count_ = 0;
};

/// Repeats a run from its inputs, which are read from the bag when they act.
class Replay {
 public:
  /// Opens a bag; the inputs of its last run count.
  /// \throws FileError, InputError naming the bag
  explicit Replay(const std::string& path);

  /// Sets the options of the run, apart from files, and returns its particles.
  Scene begin(Scenario& scenario) const;
  double displayInterval() const { return first_->display_interval; }

  /// Changes the run as the inputs did at its current time. Must be called after every state.
  /// \returns whether the run has gone to another frame
  /// \throws InputError if the inputs are not those of this run
  bool apply(Run& run);

  /// Whether the node had ended at the current time of the run.
  bool isOver(const Run& run) const {
    return next_ && next_->end != 0 && next_->time <= run.time();
  }
  std::string missing() const;  ///< a sentence if the last inputs may be missing; else empty
  /// A sentence if the run ended before all inputs acted; else empty.
  std::string unreached() const;

 private:
  /// Where the inputs are, by number: a recorder that comes late gets some twice.
  using Places = std::map<std::uint32_t, rosbag::MessageInstance>;

  void find();
  void check(const PendulumInput& input) const;
  /// Reads the input after the last one that was read; null at the end.
  PendulumInput::ConstPtr read();
  void act(const PendulumInput& input, Run& run) const;
  [[noreturn]] void refuse(const PendulumInput& input, const std::string& reason) const;

  std::string path_;
  rosbag::Bag bag_;
  Places places_;
  Places::const_iterator place_;
  PendulumInput::ConstPtr first_;     ///< the start
  PendulumInput::ConstPtr next_;      ///< null: none is left
  std::optional<std::uint32_t> end_;  ///< number of the closing input
};

}  // namespace spring_pendulum
