#include "simulator/scene/light/area_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace saccade {
namespace {

using std::numbers::pi;

/// The points of a square grid of n x n that is turned by atan(1 / n), within [-1, 1]^2.
std::vector<Eigen::Vector2d> turned_grid(std::size_t n) {
  const auto side = static_cast<double>(n);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double column = static_cast<double>(i) + (static_cast<double>(j) + 0.5) / side;
      const double row = static_cast<double>(j) + (static_cast<double>(n - 1 - i) + 0.5) / side;
      points.emplace_back(2 * column / side - 1, 2 * row / side - 1);
    }
  return points;
}

/// From the square [-1, 1]^2 to the unit disc, equal areas to equal ones.
Eigen::Vector2d on_disc(const Eigen::Vector2d& square) {
  const double x = square.x();
  const double y = square.y();
  if (x == 0 && y == 0) return Eigen::Vector2d::Zero();
  const bool is_wide = std::abs(x) > std::abs(y);
  const double radius = is_wide ? x : y;
  const double angle = is_wide ? pi / 4 * (y / x) : pi / 2 - pi / 4 * (x / y);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The axes of an area: along its width, its height, and where it shines.
Eigen::Matrix3d axes_of(const LightOptions& light) {
  constexpr double kUpright = 1e-6;
  const Eigen::Vector3d normal = light.direction.normalized();
  Eigen::Vector3d width = light.width_direction;
  if (width.isZero()) {
    const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(normal);
    width = level.norm() > kUpright ? level : Eigen::Vector3d::UnitX();
  }
  width = (width - width.dot(normal) * normal).normalized();
  Eigen::Matrix3d axes;
  axes << width, normal.cross(width), normal;
  return axes;
}

Eigen::Vector3d on_unit_sphere(const Eigen::Vector2d& point) {
  const double z = point.x();
  const double radius = std::sqrt(std::max(0.0, 1 - z * z));
  const double azimuth = pi * point.y();
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

}  // namespace

std::size_t emitter_count(const LightOptions& light) {
  return light.is_area() ? light.samples_per_side * light.samples_per_side : 1;
}

std::vector<LightOptions> emitters_of(const LightOptions& light) {
  if (!light.is_area()) return {light};
  LightOptions emitter = light;
  emitter.type = LightType::kEmitter;
  emitter.intensity /= static_cast<double>(emitter_count(light));
  // A sphere has four times the area of the disc that it looks like.
  if (light.type == LightType::kSphere) emitter.intensity *= 4;
  const Eigen::Matrix3d axes = axes_of(light);
  std::vector<LightOptions> emitters;
  for (const Eigen::Vector2d& point : turned_grid(light.samples_per_side)) {
    if (light.type == LightType::kSphere) {
      emitter.direction = on_unit_sphere(point);
      emitter.position = light.position + light.radius_m * emitter.direction;
    } else {
      const Eigen::Vector2d offset = light.type == LightType::kDisc
                                         ? Eigen::Vector2d(light.radius_m * on_disc(point))
                                         : Eigen::Vector2d(0.5 * light.size_m.cwiseProduct(point));
      emitter.direction = axes.col(2);
      emitter.position = light.position + axes.leftCols<2>() * offset;
    }
    emitters.push_back(emitter);
  }
  return emitters;
}

}  // namespace saccade
