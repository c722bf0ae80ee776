#include "eval/image_views.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/run/view_list.h"
#include "core/srgb.h"
#include "eval/metrics/depth_truth.h"
#include "eval/picture/image/image_picture.h"

namespace saccade {
namespace {

constexpr double kSameTimeS = 1e-4;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// The channel of this name; an empty image where there is none.
ImageF take(std::vector<ExrChannel>& channels, const std::string& name) {
  for (ExrChannel& channel : channels)
    if (channel.name == name) return std::move(channel.image);
  return {};
}

void read_gradient(const std::filesystem::path& file, ImageView& view) {
  std::vector<ExrChannel> channels = read_exr_channels(file);
  view.gradient_x = take(channels, "gx");
  view.gradient_y = take(channels, "gy");
  view.covariance_xx = take(channels, "Pxx");
  view.covariance_xy = take(channels, "Pxy");
  view.covariance_yy = take(channels, "Pyy");
  if (view.gradient_x.size() != view.log_image.size() ||
      view.gradient_y.size() != view.log_image.size())
    throw InputError(file.string(), "must hold gx and gy of the image's size");
}

std::size_t nearest_frame(const Dataset& dataset, double t_s) {
  const auto& frames = dataset.frames();
  std::size_t best = 0;
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (std::abs(frames[i].t_s - t_s) < std::abs(frames[best].t_s - t_s)) best = i;
  return best;
}

ImageF log_frame(const Dataset& dataset, std::size_t frame) {
  ImageF image = dataset.load_frame(frame);
  const double eps = dataset.facts().log_eps;
  for (float& value : image.pixels())
    value = static_cast<float>(std::log(eps + static_cast<double>(value)));
  return undistort_image(image, dataset.camera(), kUnknown);
}

/// What the frame shows of every pixel of a view with this depth, from elsewhere.
ImageF carried_over(const ImageF& frame, const PinholeCamera& camera, const DepthTruth& at_view,
                    const DepthTruth& at_frame) {
  constexpr double kHidden =
      0.05;  // relative depth behind the surface that is visible in the frame
  ImageF result(frame.width(), frame.height(), kUnknown);
  const Rigid3 frame_from_view = at_frame.world_from_camera.inverse() * at_view.world_from_camera;
  for (int y = 0; y < frame.height(); ++y)
    for (int x = 0; x < frame.width(); ++x) {
      const auto z = static_cast<double>(at_view.depth(x, y));
      if (!(z > 0)) continue;
      const Eigen::Vector3d point = frame_from_view * (z * camera.ray({x, y}));
      if (point.z() <= 0) continue;
      const Eigen::Vector2d pixel = camera.project(point);
      if (!is_inside(frame, pixel.x(), pixel.y())) continue;
      const auto visible_m = static_cast<double>(at_frame.depth(
          static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))));
      if (!(std::abs(visible_m - point.z()) <= kHidden * point.z())) continue;
      result(x, y) = static_cast<float>(sample(frame, pixel.x(), pixel.y()));
    }
  return result;
}

ImageF truth_at(const Dataset& dataset, double t_s) {
  const std::size_t nearest = nearest_frame(dataset, t_s);
  const double frame_s = dataset.frames()[nearest].t_s;
  ImageF frame = log_frame(dataset, nearest);
  if (std::abs(frame_s - t_s) < kSameTimeS) return frame;
  const auto at_view = depth_truth_at(dataset, t_s);
  const auto at_frame = depth_truth_at(dataset, frame_s);
  if (!at_view || !at_frame) return frame;
  return carried_over(frame, dataset.camera().undistorted(), *at_view, *at_frame);
}

}  // namespace

ImageView read_log_image(const std::filesystem::path& file, double t_s) {
  std::vector<ExrChannel> channels = read_exr_channels(file);
  ImageView view;
  view.t_s = t_s;
  if (const ImageF mask = take(channels, "observed"); !mask.empty()) {
    view.observed = ImageU8(mask.width(), mask.height());
    for (std::size_t i = 0; i < mask.size(); ++i)
      view.observed.pixels()[i] = mask.pixels()[i] > 0 ? 1 : 0;
  }
  view.log_image = take(channels, "L");
  if (view.log_image.empty()) view.log_image = read_exr(file);
  return view;
}

std::vector<ImageView> load_image_views(const std::filesystem::path& folder) {
  const std::filesystem::path list = folder / "views.yaml";
  if (!std::filesystem::exists(list)) return {};
  std::vector<ImageView> views;
  for (const RunView& entry : read_view_list(list)) {
    if (entry.image.empty()) continue;
    views.push_back(read_log_image(entry.image, entry.t_s));
    if (!entry.gradient.empty()) read_gradient(entry.gradient, views.back());
  }
  return views;
}

ImageView load_image(const std::filesystem::path& file, const Dataset& dataset, double t_s) {
  if (file.extension() == ".exr") return read_log_image(file, t_s);
  ImageView view;
  view.t_s = t_s;
  const ImageU8 codes = read_image_grey(file);
  view.log_image = ImageF(codes.width(), codes.height());
  for (std::size_t i = 0; i < codes.size(); ++i)
    view.log_image.pixels()[i] = static_cast<float>(std::log(
        dataset.facts().log_eps + static_cast<double>(linear_from_srgb8(codes.pixels()[i]))));
  return view;
}

std::optional<ImageComparison> compare_image(const ImageView& view, const Dataset& dataset) {
  const PinholeCamera& camera = dataset.camera();
  if (view.log_image.width() != camera.width || view.log_image.height() != camera.height)
    throw InputError("image", "has another size than the sensor of " + dataset.folder().string());
  if (dataset.frames().empty()) return std::nullopt;
  ImageComparison c;
  c.t_s = view.t_s;
  c.estimate = view.log_image;
  c.truth = truth_at(dataset, view.t_s);
  c.gradient_x = view.gradient_x;
  c.gradient_y = view.gradient_y;
  c.mask = view.observed.empty() ? ImageU8(camera.width, camera.height, 1) : view.observed;
  c.observed = static_cast<double>(std::count(c.mask.pixels().begin(), c.mask.pixels().end(), 1)) /
               static_cast<double>(c.mask.size());
  for (std::size_t i = 0; i < c.mask.size(); ++i)
    if (!std::isfinite(c.truth.pixels()[i]) || !std::isfinite(c.estimate.pixels()[i])) {
      c.mask.pixels()[i] = 0;
      c.truth.pixels()[i] = 0;
    }
  return c;
}

Metrics score_images(const std::vector<ImageView>& views, const Dataset& dataset) {
  std::vector<std::optional<ImageScores>> scores;
  for (const ImageView& view : views) {
    const auto comparison = compare_image(view, dataset);
    scores.push_back(comparison ? score_image(*comparison) : std::nullopt);
  }
  Metrics metrics;
  set_image_scores(metrics, scores);
  return metrics;
}

}  // namespace saccade
