// Keeps a node registered with the ROS master. A restarted master has no registrations, and roscpp
// registers a topic only once, when it is advertised.
#pragma once

#include <ros/publisher.h>
#include <ros/service_server.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace spring_pendulum {

/// Checks periodically, in a separate thread, whether the node is still registered, and registers
/// its topics and services again if not. Existing connections are not affected.
class MasterRegistration {
 public:
  MasterRegistration() = default;
  ~MasterRegistration() { stop(); }
  MasterRegistration(const MasterRegistration&) = delete;
  MasterRegistration& operator=(const MasterRegistration&) = delete;

  void addTopic(const std::string& topic, const std::string& type);
  void addService(const std::string& service);
  /// Starts the thread. Nothing can be added after this.
  void keep();
  void stop();

 private:
  struct Topic {
    std::string name;
    std::string type;
  };
  struct Service {
    std::string name;
    std::string uri;  ///< "rosrpc://host:port"
  };

  void watch();
  void renew() const;

  std::string node_uri_;
  std::vector<Topic> topics_;
  std::vector<Service> services_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace spring_pendulum
