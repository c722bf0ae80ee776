#include "estimator/reconstruction/surface/depth_splat.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

constexpr float kBehindRatio =
    1.1F;  ///< ratio of depths from which on a point is behind another surface

/// A point in the image of the camera.
struct ProjectedPoint {
  int x, y;
  float depth;
};

std::vector<ProjectedPoint> project(const std::vector<Eigen::Vector3f>& points,
                                    const Rigid3& camera_from_points, const PinholeCamera& camera,
                                    int margin) {
  const Eigen::Matrix3f r = camera_from_points.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = camera_from_points.translation().cast<float>();
  std::vector<ProjectedPoint> projected;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f p = r * point + t;
    if (!(p.z() > 0)) continue;
    const Eigen::Vector2d pixel = camera.project(p.cast<double>());
    if (!(pixel.x() > -margin && pixel.y() > -margin && pixel.x() < camera.width + margin &&
          pixel.y() < camera.height + margin))
      continue;
    projected.push_back({static_cast<int>(std::lround(pixel.x())),
                         static_cast<int>(std::lround(pixel.y())), p.z()});
  }
  return projected;
}

/// body(pixel, weight) for the pixels that the kernel around a point reaches.
template <class Body>
void for_kernel(const ProjectedPoint& point, int radius, const std::vector<float>& kernel,
                int width, int height, const Body& body) {
  for (int v = std::max(-radius, -point.y); v <= std::min(radius, height - 1 - point.y); ++v)
    for (int u = std::max(-radius, -point.x); u <= std::min(radius, width - 1 - point.x); ++u)
      body(static_cast<std::size_t>((point.y + v) * width + point.x + u),
           kernel[static_cast<std::size_t>((v + radius) * (2 * radius + 1) + u + radius)]);
}

}  // namespace

DepthSplat::DepthSplat(std::vector<Eigen::Vector3f> points, int size)
    : points_(std::move(points)), radius_(size / 2) {
  SACCADE_CHECK(size >= 1 && size <= 99 && size % 2 == 1);
  const double sigma = size / 4.0;
  for (int v = -radius_; v <= radius_; ++v)
    for (int u = -radius_; u <= radius_; ++u)
      kernel_.push_back(static_cast<float>(std::exp(-(u * u + v * v) / (2 * sigma * sigma))));
}

void DepthSplat::draw(const Rigid3& camera_from_points, const PinholeCamera& camera,
                      ImageF& inverse_depth) const {
  SACCADE_CHECK(inverse_depth.width() == camera.width && inverse_depth.height() == camera.height);
  const auto projected = project(points_, camera_from_points, camera, radius_);
  ImageF nearest(camera.width, camera.height);
  ImageF sum = nearest;
  ImageF weight = nearest;
  for (const ProjectedPoint& point : projected)
    for_kernel(point, radius_, kernel_, camera.width, camera.height, [&](std::size_t i, float) {
      float& z = nearest.pixels()[i];
      if (!(z > 0) || point.depth < z) z = point.depth;
    });
  for (const ProjectedPoint& point : projected)
    for_kernel(point, radius_, kernel_, camera.width, camera.height, [&](std::size_t i, float k) {
      if (point.depth > kBehindRatio * nearest.pixels()[i]) return;
      sum.pixels()[i] += k * point.depth;  // (6.21)
      weight.pixels()[i] += k;
    });
  for (std::size_t i = 0; i < sum.size(); ++i)
    inverse_depth.pixels()[i] = weight.pixels()[i] > 0 ? weight.pixels()[i] / sum.pixels()[i] : 0;
}

std::vector<Eigen::Vector3f> points_of(const ImageF& depth, const PinholeCamera& camera) {
  SACCADE_CHECK(depth.width() == camera.width && depth.height() == camera.height);
  const UndistortionTable undistorted(camera);
  std::vector<Eigen::Vector3f> points;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      if (const float z = depth(x, y); z > 0 && std::isfinite(z))
        points.emplace_back(z * camera.ray(undistorted(x, y).cast<double>()).cast<float>());
  return points;
}

}  // namespace saccade
