#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/animation/animation_options.h"
#include "simulator/scene/animation/mesh_animation.h"

namespace saccade {

/// Corners of a triangle: indices into the vertices of its mesh.
using CornerIndices = std::array<std::uint32_t, 3>;

/// The vertices of an animated object in its frame, at any time of a recording. Immutable and
/// thread-safe.
class VertexAnimation {
 public:
  /// `body_from_mesh` is invertible.
  VertexAnimation(const MeshAnimation& animation, const Eigen::Affine3d& body_from_mesh,
                  const AnimationOptions& options);

  /// Between pose `step` and the next one.
  struct Moment {
    std::size_t step = 0;
    double fraction = 0;  ///< in [0, 1]
    double per_s = 0;     ///< change of the fraction; 0 at rest, and within a jump
  };
  [[nodiscard]] Moment at(double t_s) const;

  [[nodiscard]] Eigen::Vector3d vertex(const Moment& moment, std::uint32_t index) const;
  /// [m/s]
  [[nodiscard]] Eigen::Vector3d velocity(const Moment& moment, std::uint32_t index) const;
  /// Unit, or zero where the mesh states none.
  [[nodiscard]] Eigen::Vector3d normal(const Moment& moment, std::uint32_t index) const;

  /// The first time after `from_s` and before `to_s` at which the motion of a vertex may have a
  /// kink. Where the animation starts again from another pose than it ended in, just before and
  /// just after.
  [[nodiscard]] std::optional<double> first_kink_s(double from_s, double to_s) const;

  [[nodiscard]] std::size_t step_count() const { return times_s_.size(); }
  [[nodiscard]] std::size_t vertex_count() const { return vertices_.front().size() - 1; }
  /// Of a pose; one more follows, which nobody uses.
  [[nodiscard]] const MeshAnimation::Vectors& vertices(std::size_t step) const {
    return vertices_[step];
  }
  /// Holds all poses.
  [[nodiscard]] const Eigen::AlignedBox3f& box() const { return box_; }

 private:
  /// Time of the animation, before the loop.
  [[nodiscard]] double played_s(double t_s) const { return (t_s - start_s_) * speed_; }

  std::vector<double> times_s_;
  double start_s_, speed_;
  bool loop_;
  bool is_closed_;  ///< the last pose is the first one
  std::vector<MeshAnimation::Vectors> vertices_;
  std::vector<MeshAnimation::Vectors> normals_;
  Eigen::AlignedBox3f box_;
};

}  // namespace saccade
