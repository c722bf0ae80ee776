#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/spline/spline.h"
#include "simulator/motion/spline_table.h"

namespace saccade {

/// A rigid object of the scene on a spline of its own; at rest before its start and after its end.
/// Immutable and thread-safe.
class MovingObject {
 public:
  /// `object`: index into the scene's mesh list. `box`: holds the object, in its own frame.
  MovingObject(std::uint32_t object, Spline world_from_object, const Eigen::AlignedBox3d& box);

  [[nodiscard]] std::uint32_t object() const { return object_; }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }
  /// The sphere around the box.
  [[nodiscard]] Eigen::Vector3d centre() const { return box_.center(); }
  [[nodiscard]] double radius() const { return 0.5 * box_.diagonal().norm(); }

  /// When it starts to move and when it comes to rest.
  [[nodiscard]] double start_s() const { return world_from_object_.start_s(); }
  [[nodiscard]] double end_s() const { return world_from_object_.end_s(); }

  [[nodiscard]] Rigid3 pose(double t_s) const { return world_from_object_.pose(t_s); }
  /// Without any motion outside the spline's span.
  [[nodiscard]] SplineState state(double t_s) const;

  /// pose() within 1e-9 per entry, ten times faster.
  [[nodiscard]] CameraFrame frame(double t_s) const;

 private:
  std::uint32_t object_;
  Spline world_from_object_;
  Eigen::AlignedBox3d box_;
  double tables_per_s_;
  std::vector<SplineTable> tables_;  ///< of equal intervals of the spline
};

}  // namespace saccade
