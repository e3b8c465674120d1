#include "ros/parameters/color.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace spring_pendulum {
namespace {

std_msgs::ColorRGBA mix(const std_msgs::ColorRGBA& from, const std_msgs::ColorRGBA& to,
                        double share) {
  const auto part = static_cast<float>(std::clamp(share, 0.0, 1.0));
  std_msgs::ColorRGBA color;
  color.r = from.r + part * (to.r - from.r);
  color.g = from.g + part * (to.g - from.g);
  color.b = from.b + part * (to.b - from.b);
  color.a = 1.0F;
  return color;
}

}  // namespace

std_msgs::ColorRGBA colorOf(std::uint32_t rgb, float opacity) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>((rgb >> 16) & 0xff) / 255.0F;
  color.g = static_cast<float>((rgb >> 8) & 0xff) / 255.0F;
  color.b = static_cast<float>(rgb & 0xff) / 255.0F;
  color.a = opacity;
  return color;
}

std::optional<std_msgs::ColorRGBA> parseColor(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  std::uint32_t rgb = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), rgb, 16);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return colorOf(rgb);
}

std_msgs::ColorRGBA strainColor(double strain) {
  static const std_msgs::ColorRGBA kShort = colorOf(0x2f7bff);
  static const std_msgs::ColorRGBA kRelaxed = colorOf(0xf2f2f2);
  static const std_msgs::ColorRGBA kStretched = colorOf(0xff3b20);
  static const std_msgs::ColorRGBA kOverstretched = colorOf(0x8c0a32);
  if (strain > 1.0) return mix(kStretched, kOverstretched, std::log2(strain) / 3.0);
  return mix(kRelaxed, strain < 0.0 ? kShort : kStretched, std::abs(strain));
}

std_msgs::ColorRGBA massColor(double mass, double lightest, double heaviest) {
  static const std_msgs::ColorRGBA kLight = colorOf(0xffe28a);
  static const std_msgs::ColorRGBA kHeavy = colorOf(0xb04bff);
  const double span = std::log(heaviest / lightest);
  return mix(kLight, kHeavy, span > 0.0 ? std::log(mass / lightest) / span : 0.0);
}

std_msgs::ColorRGBA lighter(const std_msgs::ColorRGBA& color) {
  return mix(color, colorOf(0xffffff), 0.5);
}

}  // namespace spring_pendulum
