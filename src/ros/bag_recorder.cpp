#include "ros/bag_recorder.hpp"

#include "base/numbers.hpp"
#include "io/files/output_file.hpp"
#include "io/files/paths.hpp"
#include "io/formats/run_files.hpp"
#include "ros/messages/run_messages.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <boost/make_shared.hpp>
#include <fmt/format.h>

#include <rosbag/bag.h>

#include <cerrno>
#include <memory>

namespace spring_pendulum {
namespace {

/// Returns the connection header of a topic.
template <typename Message>
boost::shared_ptr<ros::M_string> connectionHeader(const std::string& topic, bool latching) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::datatype<Message>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  (*header)["message_definition"] = ros::message_traits::definition<Message>();
  if (latching) (*header)["latching"] = "1";
  return header;
}

class BagRecorder {
 public:
  BagRecorder(rosbag::Bag& bag, const Run& run, const NodeOptions& options,
              const std::string& prefix)
      : bag_(bag),
        build_(run, options, true),
        markers_topic_(prefix + "markers"),
        state_topic_(prefix + "state"),
        status_topic_(prefix + "status"),
        status_header_(connectionHeader<PendulumStatus>(status_topic_, true)),
        camera_header_(connectionHeader<tf2_msgs::TFMessage>("/tf_static", true)) {}

  void write(const Run& run) {
    const std_msgs::Header header = build_.header(run.time());
    build_.trackTip(run);
    const visualization_msgs::MarkerArray& markers = build_.markers(run, header);
    if (const auto camera = build_.newCamera(header)) {
      write("/tf_static", header, *camera, camera_header_);
    }
    write(markers_topic_, header, markers);
    write(state_topic_, header, build_.state(run, header));
    if (auto status = build_.newStatus(run)) {
      status->header = header;
      write(status_topic_, header, *status, status_header_);
    }
  }

  std::int64_t messages() const { return messages_; }

 private:
  template <typename Message>
  void write(const std::string& topic, const std_msgs::Header& header, const Message& message,
             const boost::shared_ptr<ros::M_string>& connection = {}) {
    bag_.write(topic, header.stamp, message, connection);
    ++messages_;
  }

  rosbag::Bag& bag_;
  RunMessages build_;
  std::string markers_topic_;
  std::string state_topic_;
  std::string status_topic_;
  boost::shared_ptr<ros::M_string> status_header_;
  boost::shared_ptr<ros::M_string> camera_header_;
  std::int64_t messages_ = 0;
};

/// Returns the prefix of topics: "/euler/" for "euler" or "/euler/", "/" for empty text.
std::string topicPrefix(const std::string& name_space) {
  std::string prefix = "/" + name_space + "/";
  for (std::size_t twice = prefix.find("//"); twice != std::string::npos;
       twice = prefix.find("//")) {
    prefix.erase(twice, 1);
  }
  return prefix;
}

/// Records until the end of the run or a signal, also the status of a run that diverged.
void recordRun(Run& run, Replay* replay, BagRecorder& recorder, RunFiles& files) {
  bool goes_on = true;
  while (goes_on) {
    goes_on = run.advancePart();
    if (goes_on) {
      recorder.write(run);
      files.write(run);
    }
    if (replay == nullptr || run.wasStopped()) continue;
    // A run that is over may go back.
    goes_on = replay->apply(run) || (goes_on && !replay->isOver(run));
  }
  if (!run.isShown()) recorder.write(run);
}

}  // namespace

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

std::string recordBag(Run& run, Replay* replay, const NodeOptions& options, const BagOptions& to,
                      const std::function<void()>& started) {
  const Scenario& scenario = run.scenario();
  auto bag = std::make_unique<rosbag::Bag>();
  BagRecorder recorder(*bag, run, options, topicPrefix(to.name_space));
  // What can refuse the options is done: these remove files of earlier runs.
  TouchedFiles touched = touchedFiles(scenario, to.config);
  touched.inputs.push_back(to.inputs);
  touched.outputs.push_back(to.path);
  checkTouchedFiles(touched);
  OutputFile file(to.path);
  RunFiles files(run, to.config);
  std::int64_t messages = 0;
  bool has_earlier = false;
  try {
    has_earlier = to.append && file.copyEarlier();
    errno = 0;
    bag->open(file.unfinishedPath(),
              has_earlier ? rosbag::bagmode::Append : rosbag::bagmode::Write);
    started();
    recordRun(run, replay, recorder, files);
    bag->close();
    messages = recorder.messages();
  } catch (const rosbag::BagException& error) {
    // The text of a BagIOException has neither the file nor the reason.
    const bool is_io = dynamic_cast<const rosbag::BagIOException*>(&error) != nullptr;
    std::string reason = is_io ? "could not be written: " + messageForErrno() : error.what();
    if (is_io && has_earlier && errno == 0)
      reason = "is not a complete bag, so nothing can be appended to it";
    static_cast<void>(
        bag.release());  // its destructor would close again and throw, which ends the program
    throw FileError(fmt::format("{}: {}", file.path(), reason));
  } catch (...) {
    static_cast<void>(bag.release());
    throw;
  }
  std::string output =
      fmt::format(", {}, {} bytes in {}", counted(messages, "message"), file.size(), file.path());
  file.finish();
  files.finish();
  return output;
}

}  // namespace spring_pendulum
