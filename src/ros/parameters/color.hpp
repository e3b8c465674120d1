// Colours of the chain, for a dark background.
#pragma once

#include <std_msgs/ColorRGBA.h>

#include <optional>
#include <string_view>

namespace spring_pendulum {

/// Parses "#rrggbb" as an opaque colour; nothing for any other text.
std::optional<std_msgs::ColorRGBA> parseColor(std::string_view text);

/// Blue for a compressed spring, white for an unloaded spring, red for a stretched spring.
/// \param strain -1 and below: full blue; 0: white; 1: full red; 8 and above: dark red
std_msgs::ColorRGBA strainColor(double strain);

/// From pale yellow (light) to violet (heavy).
/// \param weight 0 for the lightest particle, 1 for the heaviest
std_msgs::ColorRGBA massColor(double weight);

/// Half-way to white, so that particles stand out from springs of the same colour.
std_msgs::ColorRGBA lighter(const std_msgs::ColorRGBA& color);

std_msgs::ColorRGBA anchorColor();
std_msgs::ColorRGBA gridColor();
std_msgs::ColorRGBA textColor();
/// Colour of the springs if the verdict is bad but the motion has not diverged.
std_msgs::ColorRGBA doubtColor();
/// Colour of the whole chain after a divergence.
std_msgs::ColorRGBA divergedColor();

}  // namespace spring_pendulum
