// Prints the option tables for scripts/generate_option_texts.py: a line of JSON per option.
#include "simulation/options/scenario_options.hpp"
#ifdef SPRING_PENDULUM_ROS
#include "ros/parameters/node_options.hpp"
#endif

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {
namespace {

std::string inJson(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

void print(std::string_view group, const std::vector<Option>& options) {
  for (const Option& option : options)
    fmt::print(
        R"({{"group": {}, "key": {}, "default": {}, "unit": {}, "range": {}, "placeholder": {}, )"
        R"("meaning": {}, "users": {}, "is_text": {}, "is_flag": {}}})"
        "\n",
        inJson(group), inJson(option.key), inJson(option.text()), inJson(option.unit),
        inJson(option.range()), inJson(option.placeholder()), inJson(option.meaning),
        inJson(option.users()), option.isText(), option.isFlag());
}

}  // namespace
}  // namespace spring_pendulum

int main() {
  using namespace spring_pendulum;
  Scenario scenario;
  print("run", scenarioOptions(scenario));
#ifdef SPRING_PENDULUM_ROS
  NodeOptions node;
  print("display", displayOptions(node));
  print("play", playOptions(node));
#endif
}
