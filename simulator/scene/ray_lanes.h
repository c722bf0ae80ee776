#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "simulator/scene/scene.h"

namespace saccade {

/// One number for each ray of a packet, in single precision.
using FloatLanes = Eigen::Array<float, static_cast<int>(kRayPacket), 1>;

/// A vector for each ray of a packet.
struct LaneVectors {
  FloatLanes x, y, z;

  [[nodiscard]] FloatLanes dot(const LaneVectors& other) const {
    return x * other.x + y * other.y + z * other.z;
  }
  [[nodiscard]] FloatLanes squared_norm() const { return dot(*this); }
};

/// A packet of rays, side by side. FloatLanes past the number in use must be finite.
struct alignas(64) RayLanes {
  LaneVectors origin, direction;
  /// RayDifferential, where textures are filtered.
  LaneVectors right, down;
};

/// What the rays of a packet see, as far as single precision tells.
struct alignas(64) ViewLanes {
  std::array<TriangleId, kRayPacket> triangles;
  std::array<std::uint32_t, kRayPacket> objects;  ///< of the triangles; kNothing for kNothing
  std::array<LightSet, kRayPacket> lights;        ///< that light the points; 0 in unlit scenes
  FloatLanes radiance;
  FloatLanes distance;  ///< along the direction [its length]; 0 = background
  FloatLanes x, y;      ///< in texels of the pyramid level that is seen; 0 without a texture
};

}  // namespace saccade
