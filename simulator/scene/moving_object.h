#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/spline/spline.h"
#include "simulator/motion/spline_table.h"
#include "simulator/scene/animation/vertex_animation.h"

namespace saccade {

/// An object of the scene on a spline of its own; at rest before its start and after its end. It is
/// rigid, or its vertices move in its frame besides. Immutable and thread-safe.
class MovingObject {
 public:
  /// `object`: index into the scene's mesh list. `world_from_object`: none where only its vertices
  /// move; its frame is the world's then. `box`: holds the object, in its own frame.
  MovingObject(std::uint32_t object, std::optional<Spline> world_from_object,
               const Eigen::AlignedBox3d& box,
               std::shared_ptr<const VertexAnimation> animation = nullptr);

  [[nodiscard]] std::uint32_t object() const { return object_; }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }
  /// Whether its frame moves.
  [[nodiscard]] bool has_trajectory() const { return has_trajectory_; }
  /// How its vertices move in its frame; nullptr: not at all.
  [[nodiscard]] const VertexAnimation* animation() const { return animation_.get(); }
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
  bool has_trajectory_;
  Spline world_from_object_;
  Eigen::AlignedBox3d box_;
  double tables_per_s_;
  std::vector<SplineTable> tables_;  ///< of equal intervals of the spline
  std::shared_ptr<const VertexAnimation> animation_;
};

}  // namespace saccade
