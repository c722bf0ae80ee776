#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "simulator/scene/animation/vertex_animation.h"
#include "simulator/scene/scene.h"

namespace saccade {

using Corners = std::array<Eigen::Vector3f, 3>;

/// Triangles numbered from `first` on.
struct TriangleRun {
  std::span<const Corners> corners;
  TriangleId first = 0;
};

/// The same of triangles whose vertices move.
struct AnimatedTriangleRun {
  std::span<const CornerIndices> corners;
  TriangleId first = 0;
};

/// Visibility and shadows among triangles of one frame, by Embree in single precision. Neighbouring
/// triangles must share bit-equal corners; then no ray slips through between them. Thread-safe once
/// built.
class EmbreeScene {
 public:
  /// Whether a triangle is opaque where a ray intersects its plane. Asked for triangles with
  /// cutouts only; thread-safe.
  using IsOpaque = std::function<bool(const Ray&, TriangleId)>;

  /// `opaque` ones stop every ray, those with cutouts where `is_opaque` says so.
  EmbreeScene(const TriangleRun& opaque, const TriangleRun& cut_out, IsOpaque is_opaque);
  /// Each ray sees the triangles as they are at its time.
  EmbreeScene(std::shared_ptr<const VertexAnimation> animation, const AnimatedTriangleRun& opaque,
              const AnimatedTriangleRun& cut_out, IsOpaque is_opaque);
  ~EmbreeScene();
  EmbreeScene(EmbreeScene&&) noexcept;
  EmbreeScene& operator=(EmbreeScene&&) noexcept;

  /// The nearest triangle along each of at most 16 coherent rays.
  void nearest(std::span<const Ray> rays, std::span<TriangleId> triangles) const;

  /// Replaces `triangles` and `distances` [length of the direction] where a nearer triangle is met.
  void nearer(std::span<const Ray> rays, std::span<TriangleId> triangles,
              std::span<float> distances) const;

  /// Marks those of at most 16 rays, not marked yet, within whose `distances` [length of the
  /// direction] anything stands.
  void find_blocked(std::span<const Ray> rays, std::span<const float> distances,
                    std::span<bool> blocked) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
