#include "simulator/scene/illumination.h"

#include <cmath>
#include <limits>

namespace saccade {
namespace {

/// The way from a point to a light; one length of `direction` ends at a point light.
struct WayToLight {
  Eigen::Vector3d direction;
  double distance;  ///< [length of direction]
  double irradiance;
};

WayToLight way_to(const LightOptions& light, const SurfacePoint& point) {
  const bool is_point = light.type == LightType::kPoint;
  const Eigen::Vector3d direction = is_point ? Eigen::Vector3d(light.position - point.position)
                                             : Eigen::Vector3d(-light.direction);
  const double squared = direction.squaredNorm();
  const double along_normal = point.shading_normal.dot(direction) / std::sqrt(squared);
  return {direction, is_point ? 1.0 : std::numeric_limits<double>::infinity(),
          light.intensity * along_normal / (is_point ? squared : 1.0)};
}

}  // namespace

Illumination::Illumination(double ambient, const std::vector<LightOptions>& lights,
                           double shadow_offset)
    : ambient_(ambient), lights_(lights), shadow_offset_(shadow_offset) {
  for (LightOptions& light : lights_) light.direction.normalize();
}

double Illumination::at(const SurfacePoint& point, const Visibility& blockers) const {
  double sum = ambient_;
  for (const LightOptions& light : lights_) {
    const WayToLight way = way_to(light, point);
    if (!(way.irradiance > 0) || point.plane_normal.dot(way.direction) <= 0) continue;
    const Ray ray{point.position + shadow_offset_ * point.plane_normal, way.direction,
                  point.time_s};
    if (light.shadows && blockers.is_blocked(ray, way.distance)) continue;
    sum += way.irradiance;
  }
  return sum;
}

}  // namespace saccade
