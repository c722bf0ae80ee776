#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/intersection/visibility.h"
#include "simulator/scene/ray_lanes.h"
#include "simulator/scene/scene_options.h"

namespace saccade {

/// A point on a surface in the world, with unit normals on the side that is seen.
struct LitPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d plane_normal;
  Eigen::Vector3d shading_normal;
  double time_s;  ///< at which it is seen
};

/// Such points for a packet of rays.
struct alignas(64) LitLanes {
  LaneVectors position, plane_normal, shading_normal;
};

/// What falls onto a Lambertian surface: ambient light and lights with shadows.
class Illumination {
 public:
  /// `shadow_offset`: how far shadow rays start above their surface [m].
  Illumination(double ambient, const std::vector<LightOptions>& lights, double shadow_offset);

  /// The lights that each of at most 16 points faces and that nothing hides from it.
  void find_unoccluded_lights(std::span<const LitPoint> points, const Visibility& blockers,
                              std::span<LightSet> lights) const;

  /// Radiance per albedo: ambient + sum of intensity cos(angle) / distance^2 (of directional lights
  /// without the distance) over `lights`.
  [[nodiscard]] double irradiance(const LitPoint& point, LightSet lights) const;

  /// Both for the points of a packet, in single precision, where `is_lit`; `blockers` are static.
  void illuminate(const LitLanes& points, const std::array<bool, kRayPacket>& is_lit,
                  const Visibility& blockers, std::span<LightSet, kRayPacket> lights,
                  FloatLanes& irradiance) const;

  /// With unit directions.
  [[nodiscard]] std::span<const LightOptions> lights() const { return lights_; }
  [[nodiscard]] double shadow_offset() const { return shadow_offset_; }

 private:
  double ambient_;
  std::vector<LightOptions> lights_;
  double shadow_offset_;
};

}  // namespace saccade
