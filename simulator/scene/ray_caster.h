#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "simulator/scene/scene.h"

namespace saccade {

using Corners = std::array<Eigen::Vector3f, 3>;

/// Visibility and shadows among triangles, by Embree in single precision. Neighbouring triangles
/// must share bit-equal corners; then no ray slips through between them. Thread-safe once built.
class RayCaster {
 public:
  /// Whether a triangle is opaque where a ray meets its plane. Asked for triangles of the second
  /// kind only; thread-safe.
  using IsOpaque = std::function<bool(const Ray&, TriangleId)>;

  /// Triangles are numbered through both lists. `corners` of the first `opaque` ones stop every
  /// ray, those of the others where `is_opaque` says so.
  RayCaster(std::span<const Corners> corners, std::size_t opaque, IsOpaque is_opaque);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// The nearest triangle along each of at most 16 coherent rays.
  void nearest(std::span<const Ray> rays, std::span<TriangleId> triangles) const;

  /// Whether anything stands within `distance` [length of the direction] of the ray's origin.
  [[nodiscard]] bool is_blocked(const Ray& ray, double distance) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
