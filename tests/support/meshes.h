#pragma once

#include <cstdint>

#include "core/image.h"
#include "core/spline/spline.h"
#include "simulator/scene/mesh/mesh.h"

namespace saccade::testing {

/// Patches of several sizes, linear radiance of about 0.05 to 1.
[[nodiscard]] ImageF patches(int width, int height, std::uint64_t seed);

/// A rectangle from `corner` along `right` and `down`, two triangles, its texture's first texel at
/// the corner.
[[nodiscard]] Mesh rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& right,
                             const Eigen::Vector3d& down, ImageF texture);

/// A large textured wall 4 m before the camera, a little slanted.
[[nodiscard]] Mesh slanted_wall();

/// A ball of 4 * `rings` * `rings` triangles, its texture wrapped around it once.
[[nodiscard]] Mesh ball(const Eigen::Vector3d& centre, double radius, std::uint32_t rings,
                        ImageF texture);

/// A torus about the z axis, of 2 * `sides` * `sides` triangles.
[[nodiscard]] Mesh torus(const Eigen::Vector3d& centre, double radius, double tube_radius,
                         std::uint32_t sides, ImageF texture);

/// A box [-size/2, size/2], every face with the whole texture.
[[nodiscard]] Mesh box(const Eigen::Vector3d& size, ImageF texture);

/// Translation, rotation and a change of speed within `duration_s`, by the seed. The camera starts
/// near the origin and looks along +z; it moves with about `speed_m_s` and `rate_rad_s`.
[[nodiscard]] Spline lively_motion(double duration_s, double speed_m_s, double rate_rad_s,
                                   std::uint64_t seed);

}  // namespace saccade::testing
