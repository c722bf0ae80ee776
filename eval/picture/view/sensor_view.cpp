#include "eval/picture/view/sensor_view.h"

#include <algorithm>
#include <cmath>

#include "core/io/events/event_file.h"
#include "core/time_search.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/colour_bar.h"
#include "eval/picture/image/event_picture.h"
#include "eval/picture/image/map_picture.h"

namespace saccade {
namespace {

/// Events further from the time of a picture are not drawn.
constexpr double kMaxEventDistanceS = 0.05;
/// Events per pixel of a picture.
constexpr double kDefaultDensity = 0.15;

}  // namespace

std::size_t current_file(const std::vector<StampedFile>& files, double t_s) {
  const std::size_t until = count_until(files, t_s, &StampedFile::t_s);
  return until > 0 ? until - 1 : 0;
}

std::optional<std::size_t> nearest_file(const std::vector<StampedFile>& files, double t_s) {
  const auto nearest = std::min_element(
      files.begin(), files.end(),
      [&](const auto& a, const auto& b) { return std::abs(a.t_s - t_s) < std::abs(b.t_s - t_s); });
  if (nearest == files.end()) return std::nullopt;
  return static_cast<std::size_t>(nearest - files.begin());
}

SensorView::SensorView(const Dataset& dataset, double start_s, double end_s,
                       const SensorViewStyle& style)
    : dataset_(dataset), camera_(dataset.camera().undistorted()), style_(style) {
  events_ = dataset.load_events(start_s - kMaxEventDistanceS, end_s + kMaxEventDistanceS);
  if (style_.events == 0)
    style_.events = static_cast<std::size_t>(kDefaultDensity * camera_.width * camera_.height);
}

std::span<const Event> SensorView::around(double t_s) const {
  return events_around(events_, t_s, style_.events, kMaxEventDistanceS);
}

ImageRgb8 SensorView::events(double t_s) const {
  return upscale(draw_events(around(t_s), camera_.width, camera_.height, style_.theme),
                 style_.upscale);
}

ImageRgb8 SensorView::map_over_events(double t_s, std::span<const Eigen::Vector3f> points_in_world,
                                      const Rigid3& world_from_camera) const {
  return draw_map_over_events(undistort_events(around(t_s), dataset_.camera()),
                              visible_points(points_in_world, world_from_camera, camera_), camera_,
                              style_.upscale, style_.theme);
}

ImageRgb8 SensorView::undistorted_events(double t_s) const {
  return upscale(draw_events(undistort_events(around(t_s), dataset_.camera()), camera_.width,
                             camera_.height, style_.theme),
                 style_.upscale);
}

std::optional<std::pair<double, ImageRgb8>> SensorView::undistorted_frame(double t_s) const {
  if (dataset_.frames().empty()) return std::nullopt;
  const std::size_t index = current_file(dataset_.frames(), t_s);
  const ImageF frame = undistort_image(dataset_.load_frame(index), dataset_.camera());
  return std::pair(dataset_.frames()[index].t_s, upscale(draw_radiance(frame), style_.upscale));
}

std::optional<ImageRgb8> SensorView::frame(double t_s) const {
  if (dataset_.frames().empty()) return std::nullopt;
  const std::size_t index = current_file(dataset_.frames(), t_s);
  return upscale(draw_radiance(dataset_.load_frame(index)), style_.upscale);
}

std::optional<ImageRgb8> SensorView::depth(double t_s) const {
  std::optional<DepthPicture> plain = plain_depth(t_s);
  if (!plain) return std::nullopt;
  return with_depth_bar(upscale(plain->image, style_.upscale), plain->range);
}

std::optional<DepthPicture> SensorView::plain_depth(double t_s) const {
  if (dataset_.depth_maps().empty()) return std::nullopt;
  const ImageF depth = dataset_.load_depth(current_file(dataset_.depth_maps(), t_s));
  const DepthRange range = depth_range(depth);
  return DepthPicture{draw_depth(depth, range, style_.theme), range};
}

RunRecord::Window time_span(const Dataset& dataset) {
  if (!dataset.events_file().empty()) {
    const EventFileInfo info = read_event_file_info(dataset.events_file());
    if (info.count > 0) return {seconds_from_ns(info.first_ns), seconds_from_ns(info.last_ns)};
  }
  if (dataset.groundtruth().empty()) return {};
  return {dataset.groundtruth().start_s(), dataset.groundtruth().end_s()};
}

}  // namespace saccade
