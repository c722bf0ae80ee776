#pragma once

#include <optional>
#include <span>
#include <vector>

#include "simulator/scene/intersection/embree_scene.h"
#include "simulator/scene/moving_object.h"
#include "simulator/scene/scene.h"

namespace saccade {

/// A ray as a moving frame sees it; distances stay what they are.
[[nodiscard]] inline Ray in_frame(const CameraFrame& frame, const Ray& ray) {
  return {frame.rotation.transpose() * (ray.origin - frame.position),
          frame.rotation.transpose() * ray.direction, ray.time_s, ray.span_s};
}

/// What a ray intersects first among the triangles that are static, in the world, and those of
/// moving objects, each in its object's own frame. Rays go through the latter only where they pass
/// an object's bounding sphere at their time. Thread-safe.
class Visibility {
 public:
  /// `static_triangles`: none where everything moves. `embree_scenes`: one for each of `objects`.
  Visibility(std::optional<EmbreeScene> static_triangles, std::vector<MovingObject> objects,
             std::vector<EmbreeScene> embree_scenes);

  /// The nearest triangle along each of at most 16 coherent rays.
  void nearest(std::span<const Ray> rays, std::span<TriangleId> triangles) const;

  /// For each of at most 16 rays whether anything stands within its `distances` [length of the
  /// direction].
  void find_blocked(std::span<const Ray> rays, std::span<const float> distances,
                    std::span<bool> blocked) const;

  [[nodiscard]] std::span<const MovingObject> objects() const { return objects_; }

 private:
  std::optional<EmbreeScene> static_triangles_;
  std::vector<MovingObject> objects_;
  std::vector<EmbreeScene> embree_scenes_;
};

}  // namespace saccade
