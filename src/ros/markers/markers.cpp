#include "ros/markers/markers.hpp"

#include "ros/parameters/color.hpp"

#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

enum Index : std::size_t { kSprings, kParticles, kAnchor, kTrail, kText, kGrid, kReference };

Marker emptyMarker(std::string name, int type) {
  Marker marker;
  marker.ns = std::move(name);
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.color = colorOf(kTextColor);
  return marker;
}

}  // namespace

std::vector<Eigen::Index> evenlyChosen(Eigen::Index particles, Eigen::Index most) {
  const Eigen::Index count = std::min(particles, most);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index k = 0; k < count; ++k) {
    chosen.push_back(count < 2 ? 0 : k * (particles - 1) / (count - 1));
  }
  return chosen;
}

Markers::Markers(const Run& run, const NodeOptions& options)
    : options_(options),
      drawn_(evenlyChosen(run.chain().size(), options.display_limit)),
      view_(run, options.held.empty()) {
  markers_.markers = {
      emptyMarker("springs", Marker::LINE_LIST),     emptyMarker("particles", Marker::SPHERE_LIST),
      emptyMarker("anchor", Marker::CUBE),           emptyMarker("trail", Marker::LINE_STRIP),
      emptyMarker("text", Marker::TEXT_VIEW_FACING), emptyMarker("grid", Marker::LINE_LIST),
      emptyMarker("reference", Marker::LINE_LIST)};
}

const visualization_msgs::MarkerArray& Markers::draw(const Run& run, const std_msgs::Header& header,
                                                     const std::string& pace) {
  const Picture picture{run, options_, view_, drawn_, pace};
  // The other chains keep to the view of the first one.
  if (run.isFinite() && run.isShown() && options_.text_row <= 1 && !camera_frozen_) {
    camera_moved_ = view_.widenFor(run.state()) || camera_moved_;
  }
  auto& markers = markers_.markers;
  for (Marker& marker : markers) marker.header = header;
  drawSprings(picture, markers[kSprings]);
  drawParticles(picture, markers[kParticles]);
  drawAnchor(picture, markers[kAnchor]);
  trail_.draw(picture, markers[kTrail]);
  drawText(picture, markers[kText]);
  drawGrid(picture, markers[kGrid]);
  drawReference(picture, markers[kReference]);
  for (Marker& marker : markers) {  // rviz reports an error for a list without points
    const bool is_list = marker.type == Marker::LINE_LIST || marker.type == Marker::LINE_STRIP ||
                         marker.type == Marker::SPHERE_LIST;
    marker.action = is_list && marker.points.size() < 2 ? Marker::DELETE : Marker::ADD;
  }
  return markers_;
}

std::optional<geometry_msgs::TransformStamped> Markers::newCamera(const std_msgs::Header& header) {
  if (options_.camera_frame.empty() || options_.text_row > 1) return std::nullopt;
  if (!std::exchange(camera_moved_, false)) return std::nullopt;
  geometry_msgs::TransformStamped camera;
  camera.header = header;
  camera.child_frame_id = options_.camera_frame;
  camera.transform.translation.x = view_.box().center().x();
  camera.transform.translation.y = -view_.cameraDistance();
  camera.transform.translation.z = view_.cameraHeight();
  // Rotation by 90 degrees about z: the x axis of the camera, its viewing direction, is the y axis.
  camera.transform.rotation.z = camera.transform.rotation.w = std::sqrt(0.5);
  return camera;
}

}  // namespace spring_pendulum
