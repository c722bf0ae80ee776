#include "simulator/scene/light/area_light.h"

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

/// Points of the unit disc, each of an equal area: those of a sunflower (Vogel, 1979).
std::vector<Eigen::Vector2d> sunflower(std::size_t count) {
  const double turn = pi * (3 - std::sqrt(5.0));
  std::vector<Eigen::Vector2d> points;
  for (std::size_t k = 0; k < count; ++k) {
    const double index = static_cast<double>(k);
    const double radius = std::sqrt((index + 0.5) / static_cast<double>(count));
    points.emplace_back(radius * std::cos(index * turn), radius * std::sin(index * turn));
  }
  return points;
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

}  // namespace

std::size_t emitter_count(const LightOptions& light) {
  return light.is_area() ? light.samples_per_side * light.samples_per_side : 1;
}

std::vector<LightOptions> emitters_of(const LightOptions& light) {
  if (!light.is_area()) return {light};
  LightOptions emitter = light;
  emitter.type = LightType::kEmitter;
  emitter.intensity /= static_cast<double>(emitter_count(light));
  const Eigen::Matrix3d axes = axes_of(light);
  emitter.direction = axes.col(2);
  const bool is_disc = light.type == LightType::kDisc;
  std::vector<LightOptions> emitters;
  for (const Eigen::Vector2d& point :
       is_disc ? sunflower(emitter_count(light)) : turned_grid(light.samples_per_side)) {
    const Eigen::Vector2d half =
        is_disc ? Eigen::Vector2d::Constant(light.radius_m) : Eigen::Vector2d(0.5 * light.size_m);
    emitter.position = light.position + axes.leftCols<2>() * half.cwiseProduct(point);
    emitters.push_back(emitter);
  }
  return emitters;
}

}  // namespace saccade
