#pragma once

#include <Eigen/Core>

#include "simulator/scene/light/flicker.h"
#include "simulator/scene/light/light_options.h"

namespace saccade {

/// What the cone of a spot leaves of its intensity at an angle a off its axis (Khronos,
/// KHR_lights_punctual, 2018):
///   f(a) = clamp((cos a - cos outer) / (cos inner - cos outer), 0, 1)^2
/// It has a kink at the inner angle, and no slope at the outer one.
class SpotCone {
 public:
  /// Of a spot with a direction of unit length.
  explicit SpotCone(const LightOptions& light);

  [[nodiscard]] double falloff(const Eigen::Vector3d& point) const;

  /// Bounds of falloff() along the way of a point over `length_s` > 0, which is at `middle` halfway
  /// in time. The way is taken to stay near the parabola through the three; along each of its halves
  /// the angle's cosine is bounded in closed form.
  [[nodiscard]] LightRange falloff_range(const Eigen::Vector3d& from, const Eigen::Vector3d& middle,
                                         const Eigen::Vector3d& to, double length_s) const;

  /// Whether the cone meets no point of a sphere; false where that is not certain.
  [[nodiscard]] bool misses(const Eigen::Vector3d& centre, double radius) const;

 private:
  /// Along a line in even motion, from which the point strays by `bend` or less.
  [[nodiscard]] LightRange range_along(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                       double bend, double length_s) const;
  /// The range of the falloff from that of the cosine.
  [[nodiscard]] LightRange falloff_range(const LightRange& cosine) const;

  Eigen::Vector3d position_, axis_;
  double outer_rad_;
  double cos_outer_;
  double per_cosine_;  ///< 1 / (cos inner - cos outer)
};

}  // namespace saccade
