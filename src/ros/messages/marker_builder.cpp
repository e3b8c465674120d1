#include "ros/messages/marker_builder.hpp"

#include "ros/messages/state_builder.hpp"
#include "ros/parameters/color.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

enum MarkerIndex : std::size_t { kSprings, kParticles, kAnchor, kTrail, kText, kGrid, kReference };

/// Largest number of points of the trail. rviz crashed with more than 16384 points in a LINE_STRIP.
constexpr std::size_t kMostTrailPoints = 4096;

// Sizes relative to the picture, so that scenes of any size look alike.
constexpr double kLeastDiameter = 0.009;
constexpr double kLargestDiameter = 0.036;
constexpr double kDiameterShare = 0.35;  ///< in sizes of the picture per particle
constexpr double kSpringWidth = 0.35;    ///< in diameters
constexpr double kLeastWidth = 0.0035;
constexpr int kTextLines = 3;  ///< lines of text if only one chain is shown
constexpr double kGridWidth = 0.0015;
constexpr double kRowText = 0.8;   ///< height of the text if several chains are shown
constexpr double kRowWidth = 0.7;  ///< a chain behind another one is this much wider, for every row
/// Distance of springs, and of the next row's chain, behind the particles, in diameters: rviz draws a
/// particle as a disc that faces the camera, so it is tilted by up to 28 degrees.
constexpr double kDepth = 0.3;
// In sizes of the picture, behind the plane of the motion:
constexpr double kReferenceDepth = 0.015;
constexpr double kGridDepth = 0.02;
constexpr double kMostGridLines = 100.0;  ///< in each direction; measured: 86
constexpr double kGridReach = 1.5;        ///< in widths of the scene, for wide windows

/// Returns the strain shown in full colour: twice the strain of the first spring of the hanging
/// chain.
double fullColorStrain(const Chain& chain) {
  const SpringLaw& spring = chain.spring();
  const double weight = chain.masses().tail(chain.size() - 1).sum() * std::abs(chain.gravity());
  const double stretch = spring.stiffness > 0.0 ? weight / spring.stiffness : 0.0;
  const double strain = spring.rest_length > 0.0 ? stretch / spring.rest_length : stretch;
  return std::clamp(2.0 * strain, 0.05, 5.0);
}

std::vector<std_msgs::ColorRGBA> massColors(const Chain& chain,
                                            const std::vector<Eigen::Index>& drawn,
                                            const std::string& color) {
  std::vector<std_msgs::ColorRGBA> colors;
  if (drawn.size() < 2) return {anchorColor()};
  const auto moving = chain.masses().tail(chain.size() - 1).array().log();
  const double lightest = moving.minCoeff();
  const double span = moving.maxCoeff() - lightest;
  for (const Eigen::Index i : drawn) {
    const double weight =
        span > 0.0 && i > 0 ? (std::log(chain.masses()[i]) - lightest) / span : 0.0;
    colors.push_back(color.empty() ? massColor(weight) : lighter(*parseColor(color)));
  }
  return colors;
}

visualization_msgs::Marker emptyMarker(std::string name, int type) {
  visualization_msgs::Marker marker;
  marker.ns = std::move(name);
  marker.id = 0;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = textColor();
  return marker;
}

void setScale(visualization_msgs::Marker& marker, double size) {
  marker.scale.x = marker.scale.y = marker.scale.z = size;
}

geometry_msgs::Point pointAt(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

/// Joins the texts that are not empty with commas.
std::string joined(std::initializer_list<std::string> texts) {
  std::string all;
  for (const std::string& text : texts) {
    if (!all.empty() && !text.empty()) all += ", ";
    all += text;
  }
  return all;
}

/// rviz reports an error for a list without points.
void hideIfEmpty(visualization_msgs::Marker& marker) {
  marker.action = marker.points.size() < 2 ? visualization_msgs::Marker::DELETE
                                           : visualization_msgs::Marker::ADD;
}

}  // namespace

MarkerBuilder::MarkerBuilder(const Run& run, const NodeOptions& options) : options_(options) {
  const Chain& chain = run.chain();
  const Eigen::Index stride =
      std::max<Eigen::Index>(chain.size() - 2, 0) / (options.display_limit - 1) + 1;
  for (Eigen::Index i = 0; i + 1 < chain.size(); i += stride) drawn_.push_back(i);
  drawn_.push_back(chain.size() - 1);
  mass_colors_ = massColors(chain, drawn_, options.color);
  full_color_strain_ = fullColorStrain(chain);

  using visualization_msgs::Marker;
  markers_.markers = {
      emptyMarker("springs", Marker::LINE_LIST),     emptyMarker("particles", Marker::SPHERE_LIST),
      emptyMarker("anchor", Marker::CUBE),           emptyMarker("trail", Marker::LINE_STRIP),
      emptyMarker("text", Marker::TEXT_VIEW_FACING), emptyMarker("grid", Marker::LINE_LIST),
      emptyMarker("reference", Marker::LINE_LIST)};
  markers_.markers[kReference].color.a = 0.4F;
  markers_.markers[kAnchor].color = anchorColor();
  markers_.markers[kAnchor].pose.position = pointOf(run.start(), 0);
  // rviz blends a line only if the colour of the marker is not opaque.
  markers_.markers[kTrail].color.a = 0.9F;
  markers_.markers[kGrid].color = gridColor();
  if (!options.color.empty()) markers_.markers[kText].color = *parseColor(options.color);
}

void MarkerBuilder::fitView(const Run& run, const State& state) {
  const bool drawable = run.isFinite() && run.isShown();
  // The other rows keep to the view of the first one.
  const bool may_widen = drawable && isFirstRow() && !camera_frozen_;
  if (!view_) {
    view_.emplace(run, options_.held.empty(), textLines());
    if (may_widen) view_->widenFor(state);
  } else if (!may_widen || !view_->widenFor(state)) {
    return;
  }
  if (isFirstRow()) ++camera_changes_;
  const double size = view_->size();
  const double diameter = std::clamp(kDiameterShare * size / static_cast<double>(drawn_.size()),
                                     kLeastDiameter * size, kLargestDiameter * size);
  const double width = std::max(kSpringWidth * diameter, kLeastWidth * size);
  const auto row = static_cast<double>(options_.text_row);
  setScale(markers_.markers[kSprings], width * (1.0 + kRowWidth * row));
  setScale(markers_.markers[kParticles], diameter);
  setScale(markers_.markers[kAnchor], 1.5 * diameter);
  markers_.markers[kAnchor].scale.y = 0.01 * diameter;  // flat: its underside would be black
  markers_.markers[kAnchor].pose.position.y = options_.y_offset - kDepth * diameter;
  setScale(markers_.markers[kReference], width);
  setScale(markers_.markers[kTrail], 0.5 * width);
  setScale(markers_.markers[kGrid], kGridWidth * size);
  setScale(markers_.markers[kText],
           view_->textHeight() * (options_.text_rows > 1 ? kRowText : 1.0));
  markers_.markers[kParticles].pose.position.y = row * kDepth * diameter;
  for (const MarkerIndex line : {kSprings, kTrail}) {
    markers_.markers[line].pose.position.y = (row + 1.0) * kDepth * diameter;
  }
  drawGrid();
}

void MarkerBuilder::placeText() {
  auto& text = markers_.markers[kText];
  if (options_.text_rows > 1) {
    placeRow(text);
    return;
  }
  const auto lines = static_cast<double>(1 + std::count(text.text.begin(), text.text.end(), '\n'));
  text.pose.position = pointAt(view_->box().centerX(), options_.y_offset,
                               view_->box().top + 0.5 * lines * view_->lineDistance());
}

/// Places the text at its row in the upper part of the picture, wherever the camera is: rows of several
/// nodes keep their distance from each other.
void MarkerBuilder::placeRow(visualization_msgs::Marker& text) const {
  const double rows_above = static_cast<double>(options_.text_rows - options_.text_row) - 0.5;
  const double up = view_->halfHeight() - rows_above * view_->lineDistance();
  if (options_.camera_frame.empty()) {
    text.pose.position =
        pointAt(view_->box().centerX(), options_.y_offset, view_->cameraHeight() + up);
  } else {
    text.header.frame_id = options_.camera_frame;
    text.pose.position = pointAt(view_->cameraDistance(), 0.0, up);
  }
}

void MarkerBuilder::drawGrid() {
  auto& grid = markers_.markers[kGrid];
  grid.points.clear();
  if (!isFirstRow()) return;
  const Box& box = view_->box();
  const double distance = view_->gridDistance(), size = view_->size();
  const double y = options_.y_offset + kGridDepth * size;
  const double left = distance * std::floor((box.left - kGridReach * size) / distance);
  const double bottom = distance * std::floor((box.bottom - 0.5 * size) / distance);
  const double right = box.right + kGridReach * size, top = box.top + 0.5 * size;
  // Counted in integers: far from the origin, x + distance rounds to x.
  const auto count = [&](double length) {
    return length / distance < kMostGridLines ? static_cast<int>(length / distance) : 0;
  };
  const int columns = count(right - left), rows = count(top - bottom);
  for (int column = 0; column <= columns; ++column) {
    const double x = left + column * distance;
    grid.points.push_back(pointAt(x, y, bottom));
    grid.points.push_back(pointAt(x, y, top));
  }
  for (int row = 0; row <= rows; ++row) {
    const double z = bottom + row * distance;
    grid.points.push_back(pointAt(left, y, z));
    grid.points.push_back(pointAt(right, y, z));
  }
}

geometry_msgs::TransformStamped MarkerBuilder::camera(const std_msgs::Header& header) const {
  geometry_msgs::TransformStamped transform;
  transform.header = header;
  transform.child_frame_id = options_.camera_frame;
  transform.transform.translation.x = view_->box().centerX();
  transform.transform.translation.y = options_.y_offset - view_->cameraDistance();
  transform.transform.translation.z = view_->cameraHeight();
  // Rotation by 90 degrees about z: the x axis of the camera, its viewing direction, is the y axis.
  transform.transform.rotation.z = transform.transform.rotation.w = std::sqrt(0.5);
  return transform;
}

geometry_msgs::Point MarkerBuilder::pointOf(const State& state, Eigen::Index i) const {
  geometry_msgs::Point point;
  point.x = state.x()[i];
  point.y = options_.y_offset;
  point.z = state.y()[i];
  return point;
}

void MarkerBuilder::trackTip(const Run& run) {
  if (!trail_.empty() && run.time() < trail_.back().time) trail_.clear();
  if (options_.trail <= 0.0 || drawn_.size() < 2 || !run.isFinite() || !run.isShown()) return;
  if (!trail_.empty() && run.time() == trail_.back().time) return;
  trail_.push_back({run.time(), pointOf(run.state(), run.chain().size() - 1)});
  while (trail_.front().time < run.time() - options_.trail || trail_.size() > kMostTrailPoints) {
    trail_.pop_front();
  }
}

const visualization_msgs::MarkerArray& MarkerBuilder::build(const Run& run,
                                                            const std_msgs::Header& header,
                                                            const std::string& pace) {
  for (visualization_msgs::Marker& marker : markers_.markers) marker.header = header;
  fitView(run, run.state());
  if (run.isFinite() && run.isShown()) place(run, run.state());
  if (placed_) paint(run);
  drawTrail();
  drawReference(run);
  label(run, pace);
  placeText();
  for (const MarkerIndex list : {kSprings, kParticles, kTrail, kGrid}) {
    hideIfEmpty(markers_.markers[list]);
  }
  return markers_;
}

void MarkerBuilder::place(const Run& run, const State& state) {
  auto& particles = markers_.markers[kParticles].points;
  auto& springs = markers_.markers[kSprings].points;
  particles.clear();
  springs.clear();
  strains_.clear();
  placed_ = true;
  markers_.markers[kAnchor].pose.position.x = state.x()[0];
  markers_.markers[kAnchor].pose.position.z = state.y()[0];
  if (drawn_.size() < 2) return;
  for (std::size_t n = 0; n < drawn_.size(); ++n) {
    particles.push_back(pointOf(state, drawn_[n]));
    if (n == 0) continue;
    springs.push_back(particles[n - 1]);
    springs.push_back(particles[n]);
    const double length = springLengths(state, drawn_[n - 1], drawn_[n]);
    const auto thinned = static_cast<double>(drawn_[n] - drawn_[n - 1]);
    strains_.push_back(strainOf(length / thinned, run.chain().spring().rest_length));
  }
}

void MarkerBuilder::drawReference(const Run& run) {
  auto& reference = markers_.markers[kReference];
  reference.points.clear();
  const State* state = options_.show_reference ? run.referenceState() : nullptr;
  if (state != nullptr && state->size() == run.state().size() && state->values().allFinite()) {
    for (std::size_t n = 1; n < drawn_.size(); ++n) {
      reference.points.push_back(pointOf(*state, drawn_[n - 1]));
      reference.points.push_back(pointOf(*state, drawn_[n]));
    }
  }
  // Slightly behind the chain, to avoid flicker.
  for (geometry_msgs::Point& point : reference.points) point.y += kReferenceDepth * view_->size();
  hideIfEmpty(reference);
}

std_msgs::ColorRGBA MarkerBuilder::springColor(const Run& run, std::size_t spring) const {
  if (!options_.color.empty()) return *parseColor(options_.color);
  if (run.verdict().kind == VerdictKind::kDiverged) return divergedColor();
  if (isBad(run.verdict().kind)) return doubtColor();
  return strainColor(strains_[spring] / full_color_strain_);
}

/// Marks a diverged chain that keeps its colour: its springs have gaps.
void MarkerBuilder::breakSprings() {
  constexpr double kEnd = 0.3;  ///< length of the rest at each end, in lengths of the spring
  const auto& particles = markers_.markers[kParticles].points;
  auto& springs = markers_.markers[kSprings].points;
  springs.clear();
  for (std::size_t n = 1; n < particles.size(); ++n) {
    const geometry_msgs::Point &from = particles[n - 1], &to = particles[n];
    const double dx = kEnd * (to.x - from.x), dz = kEnd * (to.z - from.z);
    for (const auto& point : {from, pointAt(from.x + dx, from.y, from.z + dz),
                              pointAt(to.x - dx, to.y, to.z - dz), to}) {
      springs.push_back(point);
    }
  }
}

void MarkerBuilder::paint(const Run& run) {
  auto& springs = markers_.markers[kSprings];
  auto& particles = markers_.markers[kParticles];
  const bool diverged = run.verdict().kind == VerdictKind::kDiverged;
  if (diverged && !options_.color.empty()) breakSprings();
  springs.colors.clear();
  for (std::size_t spring = 0; spring < strains_.size(); ++spring) {
    const std::size_t points = springs.points.size() / strains_.size();
    springs.colors.insert(springs.colors.end(), points, springColor(run, spring));
  }
  particles.colors.assign(particles.points.size(), divergedColor());
  if ((!diverged || !options_.color.empty()) && particles.points.size() > 1) {
    particles.colors = mass_colors_;
    for (std::size_t n = 1; n < drawn_.size(); ++n) {
      if (run.chain().isHeld(drawn_[n])) particles.colors[n] = anchorColor();
    }
  }
}

void MarkerBuilder::drawTrail() {
  auto& trail = markers_.markers[kTrail];
  trail.points.clear();
  trail.colors.clear();
  for (const TrailPoint& point : trail_) {
    trail.points.push_back(point.point);
    std_msgs::ColorRGBA color =
        options_.color.empty() ? lighter(mass_colors_.back()) : *parseColor(options_.color);
    const double age = (trail_.back().time - point.time) / options_.trail;
    color.a = static_cast<float>(std::max(0.9 * (1.0 - age), 0.02));
    trail.colors.push_back(color);
  }
}

int MarkerBuilder::textLines() const {
  return std::max(kTextLines, static_cast<int>(options_.text_rows));
}

void MarkerBuilder::label(const Run& run, const std::string& pace) {
  const Scenario& scenario = run.scenario();
  const bool fixed_step = scenario.method.get().hasFixedStep();
  const EnergyEntry entry = run.energyEntry();
  const std::string clock = fmt::format("t = {:.2f} s", run.time());
  const std::string error =
      entry.relative_residual ? fmt::format("energy error {:.1e}", *entry.relative_residual) : "";
  const double position_error = run.positionError().now;
  const std::string position =
      std::isnan(position_error) ? "" : fmt::format("position error {:.1e} m", position_error);
  std::string verdict(toString(run.verdict().kind));
  if (isBad(run.verdict().kind)) {
    verdict += fmt::format(" at {:.4g} s", run.verdict().time);
  }
  std::string& text = markers_.markers[kText].text;
  if (options_.text_rows > 1) {
    text = joined(
        {scenario.method.get().name + ": " + clock, position.empty() ? error : position, verdict});
    return;
  }
  text = joined({scenario.method.get().name,
                 fixed_step ? fmt::format("time step {:.3g} s", scenario.time_step)
                            : fmt::format("tolerance {:.3g} m", scenario.tolerance),
                 clock}) +
         "\n" + joined({position, error, verdict}) + "\n" +
         joined({pace, fmt::format("grid {:g} m", view_->gridDistance()),
                 static_cast<Eigen::Index>(drawn_.size()) < run.chain().size()
                     ? fmt::format("{} of {} particles drawn", drawn_.size(), run.chain().size())
                     : ""});
}

}  // namespace spring_pendulum
