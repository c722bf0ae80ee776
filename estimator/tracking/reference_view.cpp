#include "estimator/tracking/reference_view.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"

namespace saccade {
namespace {

/// Depth maps belong to a frame when their times agree to a tenth of a millisecond.
constexpr double kSameTime_s = 1e-4;

template <class Read>
ImageF undistort(const ImageF& image, const PinholeCamera& camera, float outside,
                 const Read& read) {
  ImageF out(image.width(), image.height(), outside);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Eigen::Vector2d p = camera.distort({x, y});
      if (is_inside(image, p.x(), p.y())) out(x, y) = read(p.x(), p.y());
    }
  return out;
}

std::size_t reference_index(const Dataset& dataset, const ReferenceOptions& options,
                            double start_s) {
  const auto& frames = dataset.frames();
  const std::string source = dataset.folder().string();
  if (frames.empty()) throw InputError(source, "holds no frames (images.txt) to take the map from");
  if (options.frame) {
    if (static_cast<std::size_t>(*options.frame) >= frames.size())
      throw InputError("reference.frame", fmt::format("{} is beyond the {} frames of {}",
                                                      *options.frame, frames.size(), source));
    return static_cast<std::size_t>(*options.frame);
  }
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i].t_s >= start_s - kSameTime_s) return i;
  throw InputError(source, fmt::format("holds no frame at or after the start at {} s", start_s));
}

ImageF load_depth_at(const Dataset& dataset, double t_s) {
  const auto& maps = dataset.depth_maps();
  for (std::size_t i = 0; i < maps.size(); ++i)
    if (std::abs(maps[i].t_s - t_s) <= kSameTime_s) return dataset.load_depth(i);
  throw InputError(dataset.folder().string(),
                   fmt::format("holds no depth map at {} s, the time of the reference frame; "
                               "state reference.planar_depth_m to track a planar map",
                               t_s));
}

void check_size(const ImageF& image, const PinholeCamera& camera, const std::string& source) {
  if (image.width() != camera.width || image.height() != camera.height)
    throw InputError(source, fmt::format("is {} x {}, the sensor {} x {}", image.width(),
                                         image.height(), camera.width, camera.height));
}

/// Outside the region no depth is known, so that no map point arises there.
void keep_region(const std::array<double, 4>& region, ImageF& depth) {
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      if (x < region[0] || y < region[1] || x > region[2] || y > region[3]) depth(x, y) = 0;
}

ReferenceView load_view(const Dataset& dataset, const PinholeCamera& camera,
                        const ReferenceOptions& options, std::size_t index) {
  const StampedFile& frame = dataset.frames()[index];
  ReferenceView view;
  const ImageF radiance = dataset.load_frame(index);
  check_size(radiance, camera, frame.file.string());
  view.log_intensity = radiance;
  for (float& value : view.log_intensity.pixels())
    value = static_cast<float>(std::log(static_cast<double>(value) + dataset.facts().log_eps));
  view.log_intensity =
      undistort_bilinear(view.log_intensity, camera, std::numeric_limits<float>::quiet_NaN());

  if (options.planar_depth_m) {
    view.depth = ImageF(camera.width, camera.height, static_cast<float>(*options.planar_depth_m));
  } else {
    const ImageF depth = load_depth_at(dataset, frame.t_s);
    check_size(depth, camera, dataset.folder().string() + ": depth map");
    view.depth = undistort_nearest(depth, camera, 0);
  }
  if (options.region_px) keep_region(*options.region_px, view.depth);
  if (!dataset.groundtruth().empty())
    view.world_from_reference = dataset.groundtruth().at_clamped(frame.t_s + options.time_offset_s);
  return view;
}

}  // namespace

ImageF undistort_bilinear(const ImageF& image, const PinholeCamera& camera, float outside) {
  if (!camera.is_distorted()) return image;
  return undistort(image, camera, outside,
                   [&](double x, double y) { return static_cast<float>(sample(image, x, y)); });
}

ImageF undistort_nearest(const ImageF& image, const PinholeCamera& camera, float outside) {
  if (!camera.is_distorted()) return image;
  return undistort(image, camera, outside, [&](double x, double y) {
    return image(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)));
  });
}

std::vector<ReferenceView> load_references(const Dataset& dataset, const PinholeCamera& camera,
                                           const ReferenceOptions& options, double start_s,
                                           double end_s) {
  const std::size_t first = reference_index(dataset, options, start_s);
  std::vector<ReferenceView> views{load_view(dataset, camera, options, first)};
  if (!options.new_view_deg) return views;
  if (dataset.groundtruth().empty())
    throw InputError("reference.new_view_deg",
                     dataset.folder().string() + " holds no groundtruth.txt for further views");
  const double new_view = *options.new_view_deg * std::numbers::pi / 180;
  const auto& frames = dataset.frames();
  for (std::size_t i = first + 1; i < frames.size() && frames[i].t_s <= end_s; ++i) {
    const Rigid3 pose = dataset.groundtruth().at_clamped(frames[i].t_s + options.time_offset_s);
    const bool is_new = std::all_of(views.begin(), views.end(), [&](const ReferenceView& view) {
      return angle_between(view.world_from_reference.rotation(), pose.rotation()) > new_view;
    });
    if (is_new) views.push_back(load_view(dataset, camera, options, i));
  }
  return views;
}

}  // namespace saccade
