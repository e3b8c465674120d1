// Writes the messages of a run directly to a bag: without a master, as fast as possible, stamped
// with simulated time, and with the same bytes in every run.
#include "base/numbers.hpp"
#include "io/files/output_file.hpp"
#include "io/files/posix.hpp"
#include "io/files/touched_files.hpp"
#include "io/program/command_line.hpp"
#include "io/program/program.hpp"
#include "ros/inputs/input_messages.hpp"
#include "ros/messages/run_messages.hpp"
#include "ros/node/pacer.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <boost/make_shared.hpp>
#include <fmt/format.h>

#include <ros/names.h>
#include <rosbag/bag.h>

#include <cerrno>
#include <console_bridge/console.h>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

struct BagOptions {
  std::string path = "pendulum.bag";
  std::string name_space;  ///< prefix of the topics
  std::string inputs;      ///< bag whose run is repeated; empty: none
  bool append = false;     ///< add to the bag instead of replacing it
  std::string config;      ///< configuration file of the run, which must not be overwritten
};

/// Returns the connection header of a latched topic.
template <typename Message>
boost::shared_ptr<ros::M_string> latched(const std::string& topic) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::datatype<Message>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  (*header)["message_definition"] = ros::message_traits::definition<Message>();
  (*header)["latching"] = "1";
  return header;
}

/// Writes the messages about the states of a run to a bag.
class BagRecorder {
 public:
  BagRecorder(rosbag::Bag& bag, const Run& run, const NodeOptions& options, std::string prefix)
      : bag_(bag),
        messages_(run, options, true),
        pacer_(1.0, options.display_rate),
        prefix_(std::move(prefix)) {}

  /// Writes a state if it is that of a frame, or one that the display rate asks for.
  void write(const Run& run) {
    if (run.time() < std::exchange(time_, run.time())) pacer_.start(run.time(), {});
    if (!pacer_.isShown(run.time(), run.isAtFrame())) return;
    const std::optional<StateMessages> messages = messages_.build(run, {});
    stamp_ = messages->header.stamp;
    if (messages->camera) put("/tf_static", *messages->camera, true);
    put(prefix_ + "markers", *messages->markers);
    put(prefix_ + "state", *messages->state);
    if (messages->status) put(prefix_ + "status", *messages->status, true);
  }

  std::int64_t count() const { return count_; }

 private:
  template <typename Message>
  void put(const std::string& topic, const Message& message, bool is_latched = false) {
    bag_.write(topic, stamp_, message,
               is_latched ? latched<Message>(topic) : boost::shared_ptr<ros::M_string>());
    ++count_;
  }

  rosbag::Bag& bag_;
  RunMessages messages_;
  Pacer pacer_;
  std::string prefix_;
  ros::Time stamp_;
  double time_ = 0.0;  ///< s, of the last state
  std::int64_t count_ = 0;
};

/// Records until the end of the run or a signal, also the status of a run that diverged.
void recordRun(Run& run, Replay* replay, BagRecorder& recorder, RunFiles& files) {
  for (bool goes_on = true; goes_on;) {
    const bool was_shown = run.isShown();
    goes_on = run.advancePart();
    if (goes_on && !run.isFinite() && !run.isAtFrame()) goes_on = run.advance();  // as the node
    if (goes_on || (was_shown && !run.isShown())) recorder.write(run);
    if (goes_on) files.write(run);
    if (replay == nullptr || run.wasStopped()) continue;
    // A run that is over may go back.
    goes_on = replay->apply(run) || (goes_on && !replay->isOver(run));
    files.write(run);  // its state may be another now
  }
}

/// Whether ROS accepts a topic or namespace of this name; it may be empty.
bool isTopicName(std::string_view text) {
  std::string reason;
  const bool is_private = !text.empty() && text.front() == '~';
  return !is_private && ros::names::validate(std::string(text), reason);
}

std::vector<Option> bagOptions(BagOptions& o) {
  return {
      {"bag", Text{&o.path, "FILE", "a file"}, "", "the bag to write"},
      {"namespace", Text{&o.name_space, "NAME", "a name that ROS accepts", isTopicName}, "",
       "put before the topics markers, state and status"},
      {"inputs", Text{&o.inputs, "FILE", "a bag"}, "",
       "bag with the inputs of a node, whose run is repeated bit for bit; method, constants, "
       "numbers and particles come from it"},
      {"append", Flag{&o.append}, "", "add to an existing bag, for example another method's run"},
  };
}

/// Records a run. The same scenario and options give the same bytes. The bag is complete or absent; when
/// appending, a longer copy replaces it at the end. After a signal, it ends with the last message before.
/// \param started called when nothing about the files can be refused any more, before the run
/// \returns for the closing line: ", 501 messages, 123456 bytes in /home/me/pendulum.bag"
/// \throws FileError naming the bag
std::string recordBag(Run& run, const Scenario& scenario, Replay* replay,
                      const NodeOptions& options, const BagOptions& to,
                      const std::function<void()>& started) {
  auto bag = std::make_unique<rosbag::Bag>();
  // "/euler/" for "euler" or "/euler/", "/" for empty text.
  BagRecorder recorder(*bag, run, options,
                       std::regex_replace("/" + to.name_space + "/", std::regex("//+"), "/"));
  TouchedFiles touched = touchedFiles(scenario, to.config);
  touched.inputs.push_back(to.inputs);
  touched.outputs.push_back(to.path);
  checkTouchedFiles(touched);
  OutputFile file(to.path);
  std::optional<RunFiles> files;
  std::int64_t messages = 0;
  bool has_earlier = false;
  try {
    has_earlier = to.append && file.copyEarlier();
    errno = 0;
    bag->open(file.unfinishedPath(),
              has_earlier ? rosbag::bagmode::Append : rosbag::bagmode::Write);
    files.emplace(run, scenario, to.config);  // last: removes the frames of earlier runs
    started();
    recordRun(run, replay, recorder, *files);
    bag->close();
    messages = recorder.count();
  } catch (const rosbag::BagException& error) {
    // The text of a BagIOException has neither the file nor the reason.
    const bool is_io = dynamic_cast<const rosbag::BagIOException*>(&error) != nullptr;
    std::string reason = is_io ? "could not be written: " + messageForErrno() : error.what();
    if (is_io && has_earlier && errno == 0)
      reason = "is not a complete bag, so nothing can be appended to it";
    static_cast<void>(bag.release());  // its destructor would throw, which ends the program
    throw FileError(fmt::format("{}: {}", file.path(), reason));
  } catch (...) {
    static_cast<void>(bag.release());
    throw;
  }
  std::string output =
      fmt::format(", {}, {} bytes in {}", counted(messages, "message"), file.size(), file.path());
  file.finish();
  files->finish();
  return output;
}

int record(int argc, const char* const* argv) {
  ProgramText program{"record_bag",
                      "Writes the messages that pendulum_node publishes straight into a bag.",
                      "Runge-Kutta-4 particle.txt --bag pendulum.bag"};
  program.method_from = "inputs";
  Scenario scenario;
  scenario.output.clear();  // frame files only with --output
  NodeOptions display;
  BagOptions bag;
  OptionSet options(bagOptions(bag));
  options.add(displayOptions(display));
  options.add(scenarioOptions(scenario));
  const Switches switches = parseCommandLine(argc, argv, program, options, scenario);
  printOutput(switches.answer);
  if (!switches.answer.empty()) return kDone;
  if (options.placeOf("output") != "--output") scenario.no_frames = true;
  checkNodeOptions(display);
  bag.config = switches.config;
  console_bridge::noOutputHandler();  // rosbag also throws what it prints of a damaged bag
  std::optional<Replay> replay;
  if (!bag.inputs.empty()) replay.emplace(bag.inputs);
  double display_interval = display.display_rate > 0.0 ? 1.0 / display.display_rate : 0.0;
  if (replay) display_interval = replay->displayInterval();
  const Scene scene = replay ? replay->begin(scenario) : readScene(scenario);
  Run run(scene, scenario,
          {display.track_dissipation || !scenario.energy.empty(), display_interval, interruption});
  if (switches.has("check")) return printAdvice(run);
  catchInterruptions();
  const std::string remarks = startLines(run) + warningLine(replay ? replay->missing() : "");
  const std::string output = recordBag(run, scenario, replay ? &*replay : nullptr, display, bag,
                                       [&] { printError(remarks); });
  printClosingLine(run.closingLine(output));
  if (replay && interruption() == 0) printError(warningLine(replay->unreached()));
  return conclude(run);
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  const int status = runProgram([&] { return record(argc, argv); });
  if (status != kFileFailed && status != kBadInput) return status;
  // A bag that could not be written can't be closed either (see recordBag). At a regular exit,
  // the plugin loader of rosbag in Debian 13 would warn about objects that still exist.
  std::fflush(stdout);
  std::_Exit(status);
}
