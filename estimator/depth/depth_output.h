#pragma once

#include <filesystem>
#include <span>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

/// Writes what was found into a run folder: depth/depth_%08d.exr (channels Z [m] and variance of Z
/// [m^2]; a pixel holds the point with the smallest sigma of the points that fall on it, 0 where there is none),
/// keypoints/keypoints_%08d.png, views.yaml, and cloud.ply in the world with each point's view,
/// pixel, depth and the depth's sigma. `results`: one per window.
void write_depth(const std::filesystem::path& folder, const PinholeCamera& camera,
                 std::span<const ViewWindow> windows, std::span<const DepthResult> results);

/// One depth map of write_depth(). `camera`: undistorted.
void write_depth_map(const std::filesystem::path& file, const PinholeCamera& camera,
                     const DepthResult& result);

}  // namespace saccade
