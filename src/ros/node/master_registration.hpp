// Keeps a node registered with the ROS master. A restarted master has no registrations, and roscpp
// registers a topic or service only once.
#pragma once

#include <atomic>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace spring_pendulum {

/// Checks periodically, in a separate thread, whether the node is still registered, and registers
/// its topics and services again if not. Existing connections are not affected.
class MasterRegistration {
 public:
  /// Records the topics and services that the node has registered so far, and starts to watch.
  MasterRegistration();
  ~MasterRegistration();
  MasterRegistration(const MasterRegistration&) = delete;
  MasterRegistration& operator=(const MasterRegistration&) = delete;

  /// Returns the other nodes that published topics of this node at the start, with these topics.
  const std::map<std::string, std::vector<std::string>>& rivals() const { return rivals_; }

 private:
  struct Entry {
    std::string method;   ///< of the master: "registerPublisher"
    std::string name;     ///< of the topic or service
    std::string details;  ///< type of the topic, address of the service
  };

  void record();
  void watch();
  void renew() const;

  std::vector<Entry> entries_;
  std::map<std::string, std::vector<std::string>> rivals_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace spring_pendulum
