#include "ros/markers/picture.hpp"

namespace spring_pendulum {

std::vector<Eigen::Index> evenlyChosen(Eigen::Index particles, Eigen::Index most) {
  const Eigen::Index count = std::min(particles, most);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index k = 0; k < count; ++k)
    chosen.push_back(count < 2 ? 0 : k * (particles - 1) / (count - 1));
  return chosen;
}

std_msgs::ColorRGBA colorOf(std::uint32_t rgb, float opacity) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>((rgb >> 16) & 0xff) / 255.0F;
  color.g = static_cast<float>((rgb >> 8) & 0xff) / 255.0F;
  color.b = static_cast<float>(rgb & 0xff) / 255.0F;
  color.a = opacity;
  return color;
}

std_msgs::ColorRGBA colorOf(const std::string& text) {
  return colorOf(static_cast<std::uint32_t>(std::stoul(text.substr(1), nullptr, 16)));
}

std_msgs::ColorRGBA mix(const std_msgs::ColorRGBA& from, const std_msgs::ColorRGBA& to,
                        double share) {
  const auto part = static_cast<float>(std::clamp(share, 0.0, 1.0));
  std_msgs::ColorRGBA color = colorOf(0);
  for (const auto channel :
       {&std_msgs::ColorRGBA::r, &std_msgs::ColorRGBA::g, &std_msgs::ColorRGBA::b})
    color.*channel = from.*channel + part * (to.*channel - from.*channel);
  return color;
}

}  // namespace spring_pendulum
