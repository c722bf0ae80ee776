#include "eval/picture/image/path_picture.h"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/scale_bar.h"

namespace saccade {
namespace {

constexpr double kMarginPx = 34;
/// The smallest drawn extent, for a camera that does not move horizontally.
constexpr double kMinExtentM = 1e-3;

void extend(Eigen::AlignedBox2d& box, const Trajectory& path) {
  for (const StampedPose& pose : path.poses())
    box.extend(Eigen::Vector2d(pose.world_from_camera.translation().head<2>()));
}

}  // namespace

TopDownPath::TopDownPath(const Trajectory& truth, const Trajectory& estimate, int width, int height,
                         const Theme& theme)
    : truth_(truth), estimate_(estimate), width_(width), height_(height), theme_(theme) {
  Eigen::AlignedBox2d box;
  extend(box, truth);
  extend(box, estimate);
  if (box.isEmpty()) return;
  centre_m_ = box.center();
  const Eigen::Vector2d extent_m = box.sizes().cwiseMax(kMinExtentM);
  px_per_m_ = std::min(std::max(width - 2 * kMarginPx, 1.0) / extent_m.x(),
                       std::max(height - 2 * kMarginPx, 1.0) / extent_m.y());
}

Eigen::Vector2d TopDownPath::on_screen(const Eigen::Vector3d& position) const {
  const Eigen::Vector2d from_centre_m = position.head<2>() - centre_m_;
  return {width_ / 2.0 + px_per_m_ * from_centre_m.x(),
          height_ / 2.0 - px_per_m_ * from_centre_m.y()};
}

ImageRgb8 TopDownPath::draw(double until_s, std::span<const Eigen::Vector3d> marks) const {
  Canvas canvas(width_, height_, theme_.background);
  const auto line = [&](const Trajectory& path, double end_s, const Rgb8& colour, int thickness) {
    std::vector<Eigen::Vector2d> pixels;
    for (const StampedPose& pose : path.poses())
      if (pose.t_s <= end_s) pixels.push_back(on_screen(pose.world_from_camera.translation()));
    if (!pixels.empty()) canvas.polyline(pixels, colour, thickness);
    return pixels;
  };
  if (!truth_.empty()) line(truth_, truth_.end_s(), theme_.truth, 3);
  const auto drawn = line(estimate_, until_s, theme_.estimate, 1);
  for (const Eigen::Vector3d& mark : marks) canvas.disc(on_screen(mark), 3.5, theme_.map);
  if (!drawn.empty()) canvas.disc(drawn.back(), 5, theme_.estimate);
  if (!truth_.empty() || !estimate_.empty()) draw_scale_bar(canvas, px_per_m_, theme_);
  return canvas.image();
}

}  // namespace saccade
