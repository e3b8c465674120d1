// Colours of the chain, for a dark background.
#pragma once

#include <std_msgs/ColorRGBA.h>

#include <cstdint>
#include <optional>
#include <string_view>

namespace spring_pendulum {

std_msgs::ColorRGBA colorOf(std::uint32_t rgb, float opacity = 1.0F);  ///< rgb: 0xrrggbb

/// Parses "#rrggbb" as an opaque colour; nothing for any other text.
std::optional<std_msgs::ColorRGBA> parseColor(std::string_view text);

/// Blue for a compressed spring, white for an unloaded spring, red for a stretched spring.
/// \param strain -1 and below: full blue; 0: white; 1: full red; 8 and above: dark red
std_msgs::ColorRGBA strainColor(double strain);

/// From pale yellow (light) to violet (heavy), on a logarithmic scale.
std_msgs::ColorRGBA massColor(double mass, double lightest, double heaviest);

/// Half-way to white, so that particles stand out from springs of the same colour.
std_msgs::ColorRGBA lighter(const std_msgs::ColorRGBA& color);

constexpr std::uint32_t kTextColor = 0xe6e9ee;
constexpr std::uint32_t kGridColor = 0x788291;
constexpr std::uint32_t kHeldColor = 0x9aa4b2;      ///< of held particles
constexpr std::uint32_t kDoubtColor = 0xffb000;     ///< of springs if the verdict is bad
constexpr std::uint32_t kDivergedColor = 0xff2fd0;  ///< of the whole chain

}  // namespace spring_pendulum
