#include "eval/picture/image/trajectory_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include <Eigen/Geometry>

#include "eval/picture/canvas/canvas.h"

namespace saccade {
namespace {

constexpr double kAzimuth = -35 * std::numbers::pi / 180;
constexpr double kElevation = 28 * std::numbers::pi / 180;

/// Screen right and down of the oblique view.
Eigen::Matrix<double, 2, 3> view_directions() {
  const Eigen::Matrix3d view = (Eigen::AngleAxisd(kElevation, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(kAzimuth, Eigen::Vector3d::UnitZ()))
                                   .toRotationMatrix();
  Eigen::Matrix<double, 2, 3> directions;
  directions.row(0) = view.row(0);
  directions.row(1) = -view.row(2);
  return directions;
}

Eigen::AlignedBox3d box_around(std::span<const Eigen::Vector3d> a,
                               std::span<const Eigen::Vector3d> b) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : a) box.extend(p);
  for (const Eigen::Vector3d& p : b) box.extend(p);
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  return box;
}

/// Widens the box of a straight or resting trajectory so that it is visible.
Eigen::AlignedBox3d widened(const Eigen::AlignedBox3d& box) {
  const double min_size = std::max(1e-3, 0.1 * box.sizes().maxCoeff());
  const Eigen::Vector3d missing = (Eigen::Vector3d::Constant(min_size) - box.sizes()).cwiseMax(0);
  return {box.min() - missing / 2, box.max() + missing / 2};
}

class View {
 public:
  View(const Eigen::AlignedBox3d& box, int width, int height)
      : directions_(view_directions()), centre_in_world_(box.center()) {
    Eigen::AlignedBox2d extent;
    for (int corner = 0; corner < 8; ++corner)
      extent.extend(Eigen::Vector2d(
          directions_ *
          (box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - centre_in_world_)));
    constexpr double kMargin = 34;
    scale_ = std::min((width - 2 * kMargin) / extent.sizes().x(),
                      (height - 2 * kMargin) / extent.sizes().y());
    centre_on_screen_ = Eigen::Vector2d(width / 2.0, height / 2.0) - scale_ * extent.center();
  }

  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
    return centre_on_screen_ + scale_ * (directions_ * (p - centre_in_world_));
  }

 private:
  Eigen::Matrix<double, 2, 3> directions_;
  Eigen::Vector3d centre_in_world_;
  Eigen::Vector2d centre_on_screen_;
  double scale_ = 1;
};

/// `extent`: true side lengths, 0 where the box was widened to be seen.
void draw_box(Canvas& canvas, const View& view, const Eigen::AlignedBox3d& box,
              const Eigen::Vector3d& extent, const Theme& theme) {
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) continue;
      const auto at = [&](int c) {
        return view(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)));
      };
      canvas.line(at(corner), at(corner | 1 << axis), theme.faint);
    }
  const char* names = "xyz";
  for (int axis = 0; axis < 3; ++axis) {
    if (!(extent[axis] > 0)) continue;
    // x and y are written along the front edges of the floor, z along the left upright.
    Eigen::Vector3d middle = box.min();
    middle[axis] = box.center()[axis];
    if (axis == 1) middle.x() = box.max().x();
    const std::string label = fmt::format("{} {:.3g} m", names[axis], extent[axis]);
    const double shift = axis == 2 ? -70 : axis == 0 ? -60 : 6;
    Eigen::Vector2d at = view(middle) + Eigen::Vector2d(shift, axis == 2 ? 4 : 16);
    at.x() = std::clamp(at.x(), 4.0, canvas.width() - 4.0 - Canvas::text_width(label, 8));
    canvas.text(label, at, mix(theme.faint, theme.text, 0.6), 8);
  }
}

}  // namespace

ImageRgb8 draw_trajectory(std::span<const Eigen::Vector3d> truth,
                          std::span<const Eigen::Vector3d> estimate, int width, int height,
                          const Theme& theme) {
  Canvas canvas(width, height, theme.background);
  const Eigen::AlignedBox3d tight = box_around(truth, estimate);
  const Eigen::AlignedBox3d box = widened(tight);
  const View view(box, width, height);
  const Eigen::Vector3d extent =
      (tight.sizes().array() < box.sizes().array()).select(0, tight.sizes());
  draw_box(canvas, view, box, extent, theme);
  const auto draw = [&](std::span<const Eigen::Vector3d> points, const Rgb8& colour,
                        int thickness) {
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector3d& p : points) pixels.push_back(view(p));
    canvas.polyline(pixels, colour, thickness);
    if (!pixels.empty()) canvas.disc(pixels.front(), thickness + 2, colour);
  };
  draw(truth, theme.truth, 3);
  draw(estimate, theme.estimate, 1);
  return canvas.image();
}

}  // namespace saccade
