#include "eval/picture/preview_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/srgb.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/canvas/scale_bar.h"
#include "eval/picture/image/image_picture.h"

namespace saccade {
namespace {

constexpr std::size_t kPreviewColumns = 4;
/// Length of the line along a view's optical axis.
constexpr double kAxisPx = 18;

/// The radiance that becomes white: the 99.5th percentile over all views, as draw_radiance() has it
/// for one.
float white_of(std::span<const PreviewPicture> views) {
  std::vector<float> values;
  for (const PreviewPicture& view : views)
    values.insert(values.end(), view.radiance.pixels().begin(), view.radiance.pixels().end());
  if (values.empty()) return 1;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? *at : 1;
}

ImageRgb8 exposed(const ImageF& radiance, float white) {
  ImageRgb8 picture(radiance.width(), radiance.height());
  std::ranges::transform(radiance.pixels(), picture.data(), [white](float value) {
    const std::uint8_t code = srgb8_from_linear(value / white);
    return Rgb8{code, code, code};
  });
  return picture;
}

ImageRgb8 draw_plan(const PlanPicture& plan, const Theme& theme) {
  Canvas canvas(draw_radiance(plan.radiance));
  const auto on_screen = [&plan](const Eigen::Vector3d& position) {
    const Eigen::Vector2d offset = plan.px_per_m * (position.head<2>() - plan.centre_m);
    return Eigen::Vector2d(0.5 * plan.radiance.width() + offset.x() - 0.5,
                           0.5 * plan.radiance.height() - offset.y() - 0.5);
  };
  std::vector<Eigen::Vector2d> pixels;
  for (const StampedPose& pose : plan.path)
    pixels.push_back(on_screen(pose.world_from_camera.translation()));
  canvas.polyline(pixels, theme.estimate, 2);
  for (const StampedPose& view : plan.views) {
    const Eigen::Vector2d at = on_screen(view.world_from_camera.translation());
    const Eigen::Vector3d axis = view.world_from_camera.rotation() * Eigen::Vector3d::UnitZ();
    canvas.line(at, at + kAxisPx * Eigen::Vector2d(axis.x(), -axis.y()), theme.on);
    canvas.disc(at, 3, theme.estimate);
  }
  draw_scale_bar(canvas, plan.px_per_m, theme);
  return canvas.image();
}

}  // namespace

ImageRgb8 draw_preview(const std::string& title, std::span<const PreviewPicture> views,
                       const PlanPicture& plan, const Theme& theme) {
  ContactSheet sheet(title, theme);
  const float white = white_of(views);
  for (std::size_t first = 0; first < views.size(); first += kPreviewColumns) {
    std::vector<CaptionedPicture> row;
    for (const PreviewPicture& view :
         views.subspan(first, std::min(kPreviewColumns, views.size() - first)))
      row.push_back({view.caption, exposed(view.radiance, white)});
    sheet.add_row("", std::move(row));
  }
  sheet.add_row("", {{"from above, cut at the height of the path", draw_plan(plan, theme)}});
  return sheet.draw();
}

}  // namespace saccade
