#include "simulator/sensor/texture_aliasing.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "core/median.h"

namespace saccade {
namespace {

constexpr int kTimes = 8, kColumns = 8, kRows = 8;
/// Below it most of what a ray skips is within the reach of the bilinear filter.
constexpr double kManyTexels = 3;

}  // namespace

double texels_per_ray(const Scene& scene, const Spline& world_from_camera,
                      const PinholeCamera& camera, const EventOptions& options) {
  const double ray_px = options.pixel_side / std::sqrt(options.samples_per_pixel);
  std::vector<double> texels;
  for (int k = 0; k < kTimes; ++k) {
    const double span_s = world_from_camera.end_s() - world_from_camera.start_s();
    const double t_s = world_from_camera.start_s() + span_s * (k + 0.5) / kTimes;
    const Rigid3 pose = world_from_camera.pose(t_s);
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < kColumns; ++i) {
        const Eigen::Vector2d pixel(camera.width * (i + 0.5) / kColumns - 0.5,
                                    camera.height * (j + 0.5) / kRows - 0.5);
        const auto direction = [&](const Eigen::Vector2d& at) -> Eigen::Vector3d {
          return pose.rotation() * camera.ray(camera.undistort(at));
        };
        const Ray ray{pose.translation(), direction(pixel), t_s};
        TriangleId triangle = kNothing;
        scene.visible({&ray, 1}, {&triangle, 1});
        const RayDifferential next{
            ray_px * (direction(pixel + Eigen::Vector2d::UnitX()) - ray.direction),
            ray_px * (direction(pixel + Eigen::Vector2d::UnitY()) - ray.direction)};
        const SurfaceSample seen = scene.sample_surface(ray, triangle, next);
        if (triangle != kNothing && seen.texture != nullptr)
          texels.push_back(std::exp2(seen.level));
      }
  }
  constexpr std::size_t kRays = std::size_t{kTimes} * kColumns * kRows;
  return 4 * texels.size() < kRays ? 0 : median(std::move(texels));
}

std::string aliasing_warning(double texels_per_ray, const EventOptions& options) {
  if (options.texture_filter == TextureFilter::kMipmap || texels_per_ray < kManyTexels) return {};
  return fmt::format(
      "textures are finer than the pixels ({:.2g} texels per ray, median) and are sampled at "
      "points: "
      "some events are of aliasing, which no sensor would see; state events.texture_filter: "
      "mipmap{}",
      texels_per_ray, options.samples_per_pixel == 1 ? " and events.samples_per_pixel: 4" : "");
}

}  // namespace saccade
