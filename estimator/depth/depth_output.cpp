#include "estimator/depth/depth_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/ply_file.h"
#include "core/io/run/view_list.h"
#include "core/time_search.h"

namespace saccade {
namespace {

constexpr int kUpscale = 3;  ///< of the keypoint pictures

/// sigma of z = 1 / rho: sigma_rho / rho^2.
float depth_sigma(const EdgePoint& point) {
  return point.sigma / (point.inverse_depth * point.inverse_depth);
}

void draw_dot(ImageRgb8& picture, double x_px, double y_px, const Rgb8& colour) {
  const auto x = static_cast<int>(std::lround((x_px + 0.5) * kUpscale - 0.5));
  const auto y = static_cast<int>(std::lround((y_px + 0.5) * kUpscale - 0.5));
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, picture.height() - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, picture.width() - 1); ++u)
      picture(u, v) = colour;
}

/// The events around the view's time in grey, over them the candidates in red and the points in
/// green.
ImageRgb8 draw_keypoints(const PinholeCamera& camera, const ViewWindow& window,
                         const DepthResult& result) {
  ImageRgb8 picture(camera.width * kUpscale, camera.height * kUpscale, Rgb8{12, 15, 20});
  const auto count = static_cast<std::size_t>(camera.width * camera.height / 6);
  const std::size_t index = count_before(window.events, ns_from_seconds(window.reference_s));
  const std::size_t begin = index - std::min(index, count / 2);
  const std::size_t end = std::min(begin + count, window.events.size());
  for (const Event& event : window.events.subspan(begin, end - begin)) {
    const Eigen::Vector2d p = camera.undistort({event.x, event.y});
    draw_dot(picture, p.x(), p.y(), {110, 116, 124});
  }
  for (const Eigen::Vector2f& p : result.candidates)
    draw_dot(picture, static_cast<double>(p.x()), static_cast<double>(p.y()), {240, 62, 52});
  for (const EdgePoint& p : result.points)
    draw_dot(picture, static_cast<double>(p.x_px), static_cast<double>(p.y_px), {70, 225, 110});
  return picture;
}

void append(PointCloud& cloud, const PinholeCamera& camera, const ViewWindow& window,
            std::size_t view, const DepthResult& result) {
  const Rigid3 world_from_view = window.world_from_reference();
  for (const EdgePoint& point : result.points) {
    const double depth = 1 / static_cast<double>(point.inverse_depth);
    const Eigen::Vector3d in_world =
        world_from_view * (depth * camera.ray({point.x_px, point.y_px}));
    cloud.positions.emplace_back(in_world.cast<float>());
    const float values[] = {static_cast<float>(view), point.x_px, point.y_px,
                            static_cast<float>(depth), depth_sigma(point)};
    for (std::size_t i = 0; i < cloud.scalars.size(); ++i)
      cloud.scalars[i].values.push_back(values[i]);
  }
}

}  // namespace

void write_depth_map(const std::filesystem::path& file, const PinholeCamera& camera,
                     const DepthResult& result) {
  ImageF depth(camera.width, camera.height), variance(camera.width, camera.height);
  for (const EdgePoint& point : result.points) {
    const auto x = static_cast<int>(std::lround(point.x_px));
    const auto y = static_cast<int>(std::lround(point.y_px));
    if (!is_inside(depth, x, y)) continue;
    const float sigma = depth_sigma(point);
    if (depth(x, y) > 0 && variance(x, y) <= sigma * sigma) continue;
    depth(x, y) = 1 / point.inverse_depth;
    variance(x, y) = sigma * sigma;
  }
  const ExrChannel channels[] = {{"Z", std::move(depth)}, {"variance", std::move(variance)}};
  write_exr(file, channels);
}

void write_depth(const std::filesystem::path& folder, const PinholeCamera& camera,
                 std::span<const ViewWindow> windows, std::span<const DepthResult> results) {
  const PinholeCamera undistorted = camera.undistorted();
  PointCloud cloud;
  cloud.scalars = {{"view", {}}, {"x_px", {}}, {"y_px", {}}, {"depth_m", {}}, {"sigma_m", {}}};
  std::vector<RunView> views;
  std::filesystem::create_directories(folder / "depth");
  std::filesystem::create_directories(folder / "keypoints");
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const ViewWindow& window = windows[i];
    RunView view;
    view.t_s = window.reference_s;
    view.world_from_camera = window.world_from_reference();
    view.start_s = seconds_from_ns(window.events.front().t_ns);
    view.end_s = seconds_from_ns(window.events.back().t_ns);
    view.depth = folder / "depth" / fmt::format("depth_{:08}.exr", i);
    view.keypoints = folder / "keypoints" / fmt::format("keypoints_{:08}.png", i);
    write_depth_map(view.depth, undistorted, results[i]);
    write_png(view.keypoints, draw_keypoints(camera, window, results[i]));
    append(cloud, undistorted, window, i, results[i]);
    views.push_back(view);
  }
  write_view_list(folder / "views.yaml", views);
  write_ply(folder / "cloud.ply", cloud);
}

}  // namespace saccade
