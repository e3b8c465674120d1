#include "ros/markers/picture.hpp"

#include <fmt/format.h>

#include <cmath>

namespace spring_pendulum {
namespace {

/// Joins the texts that are not empty with commas.
std::string joined(std::initializer_list<std::string> texts) {
  std::string all;
  for (const std::string& text : texts) {
    if (!all.empty() && !text.empty()) all += ", ";
    all += text;
  }
  return all;
}

std::string label(const Picture& picture) {
  const Run& run = picture.run;
  const Plan& plan = run.plan();
  const Verdict& verdict = run.verdict();
  const std::string clock = fmt::format("t = {:.2f} s", run.time());
  const auto residual = run.energyEntry().relative_residual;
  const std::string energy = residual ? fmt::format("energy error {:.1e}", *residual) : "";
  const double error = run.positionError().now;
  const std::string position =
      std::isnan(error) ? "" : fmt::format("position error {:.1e} m", error);
  const std::string judged =
      fmt::format("{}{}", toString(verdict.kind),
                  isBad(verdict.kind) ? fmt::format(" at {:.4g} s", verdict.time) : "");
  if (picture.options.text_row > 0)
    return joined(
        {plan.method.get().name + ": " + clock, position.empty() ? energy : position, judged});
  const std::string control = plan.method.get().hasFixedStep()
                                  ? fmt::format("time step {:.3g} s", plan.time_step)
                                  : fmt::format("tolerance {:.3g} m", plan.tolerance);
  const auto drawn = static_cast<Eigen::Index>(picture.drawn.size()), all = run.chain().size();
  return joined({plan.method.get().name, control, clock}) + "\n" +
         joined({position, energy, judged}) + "\n" +
         joined({!run.isOver()   ? ""
                 : run.isShown() ? "finished"
                                 : "stopped",
                 fmt::format("grid {:g} m", picture.view.gridDistance()),
                 drawn < all ? fmt::format("{} of {} particles drawn", drawn, all) : ""});
}

}  // namespace

void drawText(const Picture& picture, Marker& text) {
  const SceneView& view = picture.view;
  const std::int64_t row = picture.options.text_row;
  text.text = label(picture);
  setScale(text, view.textHeight() * (row > 0 ? 0.8 : 1.0));  // of several chains
  if (!picture.options.color.empty()) text.color = colorOf(picture.options.color);
  const double line = row > 0 ? static_cast<double>(row) - 0.5 : 0.5 * SceneView::kTextLines;
  const double z = view.box.max().y() + line * view.lineDistance();
  text.pose.position = pointAt(view.box.center().x(), 0.0, z);
  // Rows of several nodes keep their distance, also when the camera of one of them moves.
  if (row == 0 || picture.options.camera_frame.empty()) return;
  text.header.frame_id = picture.options.camera_frame;
  text.pose.position = pointAt(view.cameraDistance(), 0.0, z - view.cameraHeight());
}

}  // namespace spring_pendulum
