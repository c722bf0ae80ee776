#include "estimator/tracking/edges/tracking_figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/io/images/exr_file.h"
#include "core/random.h"
#include "estimator/tracking/edges/event_frame.h"
#include "estimator/tracking/edges/point_selection.h"

namespace saccade {
namespace {

/// The image with 1 at the pixels nearest to points given by (x, y) of K^-1 u.
class PointMask {
 public:
  explicit PointMask(const PinholeCamera& camera)
      : camera_(camera), image_(camera.width, camera.height) {}

  void mark(const Eigen::Vector2f& ray) {
    const auto u = std::lround(camera_.fx * static_cast<double>(ray.x()) + camera_.cx);
    const auto v = std::lround(camera_.fy * static_cast<double>(ray.y()) + camera_.cy);
    if (u < 0 || v < 0 || u >= image_.width() || v >= image_.height()) return;
    image_(static_cast<int>(u), static_cast<int>(v)) = 1;
  }
  [[nodiscard]] ImageF take() { return std::move(image_); }

 private:
  PinholeCamera camera_;
  ImageF image_;
};

ImageF gradient_magnitude(const ImageF& image) {
  ImageF magnitude(image.width(), image.height());
  for (int v = 1; v + 1 < image.height(); ++v)
    for (int u = 1; u + 1 < image.width(); ++u) {
      const float value =
          std::hypot(image(u + 1, v) - image(u - 1, v), image(u, v + 1) - image(u, v - 1)) / 2;
      if (std::isfinite(value)) magnitude(u, v) = value;
    }
  return magnitude;
}

ImageF map_pixels(const MapPoints& map, const PinholeCamera& camera) {
  PointMask mask(camera);
  for (std::size_t i = 0; i < map.size(); ++i)
    mask.mark({map.x[i] / map.z[i], map.y[i] / map.z[i]});
  return mask.take();
}

/// Mask and depth of a drawn template.
std::pair<ImageF, ImageF> images_of(const TemplateDrawer& drawer, const PinholeCamera& camera) {
  ImageF mask(camera.width, camera.height), depth(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      mask(x, y) = drawer.image().row(y)[x];
      const float inverse = drawer.inverse_depth(x, y);
      depth(x, y) = inverse > 0 ? 1 / inverse : 0;
    }
  return {std::move(mask), std::move(depth)};
}

ImageF event_image(std::span<const Event> events, const PinholeCamera& camera) {
  EventFrame frame(camera);
  frame.draw(events);
  ImageF image(frame.width(), frame.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = static_cast<float>(frame(x, y)) / EventFrame::kFull;
  return image;
}

/// One point from each of as many equal runs of the template as there are samples, as one iteration
/// takes them.
std::vector<TemplatePoint> random_points(std::span<const TemplatePoint> points, int samples) {
  const Random random(1);
  std::vector<TemplatePoint> chosen;
  const auto count = std::min(static_cast<std::size_t>(samples), points.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * points.size() / count;
    const std::size_t end = (i + 1) * points.size() / count;
    chosen.push_back(points[begin + random.below(end - begin, 0, i)]);
  }
  return chosen;
}

std::vector<ExrChannel> selections(std::span<const TemplatePoint> points,
                                   const PinholeCamera& camera, const AlignOptions& options) {
  using Kind = SelectionOptions::Kind;
  std::vector<ExrChannel> channels;
  const auto add = [&](const char* name, std::span<const TemplatePoint> chosen) {
    PointMask mask(camera);
    for (const TemplatePoint& point : chosen) mask.mark(point.ray);
    channels.push_back({name, mask.take()});
  };
  for (const auto& [name, kind] : {std::pair{"dense", Kind::kDense},
                                   {"semi_dense", Kind::kSemiDense},
                                   {"sparse_patches", Kind::kSparsePatches}}) {
    SelectionOptions selection = options.selection;
    selection.kind = kind;
    PointSelector selector(selection, camera);
    add(name, selector.select(points));
  }
  add("random", random_points(points, options.samples));
  return channels;
}

}  // namespace

void write_tracking_figures(const std::filesystem::path& folder, const EdgeTrackerOptions& options,
                            const PinholeCamera& camera, const ReferenceView& reference,
                            const MapPoints& map, const TrackingMoment& moment) {
  const PinholeCamera undistorted = camera.undistorted();
  TemplateOptions unblurred = options.templates;
  unblurred.blur_size_px = 1;
  TemplateDrawer sharp(undistorted, unblurred, map);
  TemplateDrawer blurred(undistorted, options.templates, map);
  const Rigid3 camera_from_map = moment.map_from_camera.inverse();
  static_cast<void>(sharp.draw(camera_from_map));
  const std::span<const TemplatePoint> points = blurred.draw(camera_from_map);
  auto [mask, mask_depth] = images_of(sharp, undistorted);
  auto [smooth, smooth_depth] = images_of(blurred, undistorted);
  std::vector<ExrChannel> channels = {{"L", reference.log_intensity},
                                      {"gradient", gradient_magnitude(reference.log_intensity)},
                                      {"map", map_pixels(map, undistorted)},
                                      {"mask", std::move(mask)},
                                      {"mask_depth", std::move(mask_depth)},
                                      {"template", std::move(smooth)},
                                      {"template_depth", std::move(smooth_depth)},
                                      {"events", event_image(moment.events, camera)}};
  for (ExrChannel& channel : selections(points, undistorted, options.align))
    channels.push_back(std::move(channel));
  std::filesystem::create_directories(folder / "figures");
  write_exr(folder / "figures" / "tracking.exr", channels);
}

}  // namespace saccade
