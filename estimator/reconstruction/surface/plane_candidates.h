#pragma once

#include <span>
#include <vector>

#include "estimator/reconstruction/surface/inverse_depth_plane.h"

namespace saccade {

/// The plane around each anchor, through its neighbours on the same surface (LocalPlanes).
[[nodiscard]] std::vector<InverseDepthPlane> planes_around(std::span<const SurfaceAnchor> anchors);

/// Planes that many anchors lie on, anywhere in the image, by a greedy search: the plane of `local`
/// with the most inliers, refitted to them; then the best for the remaining anchors, and so on.
[[nodiscard]] std::vector<InverseDepthPlane> common_planes(
    std::span<const SurfaceAnchor> anchors, std::span<const InverseDepthPlane> local);

}  // namespace saccade
