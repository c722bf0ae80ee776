#pragma once

#include <span>
#include <vector>

#include "estimator/reconstruction/image_plane.h"

namespace saccade {

/// The plane around each anchor, through its neighbours on the same surface (LocalPlanes).
[[nodiscard]] std::vector<ImagePlane> planes_around(std::span<const SurfaceAnchor> anchors);

/// Planes that many anchors lie on, wherever they are: the one of `local` with the most of them,
/// fitted to them anew; then the best for those that are left, and so on.
[[nodiscard]] std::vector<ImagePlane> common_planes(std::span<const SurfaceAnchor> anchors,
                                                    std::span<const ImagePlane> local);

}  // namespace saccade
