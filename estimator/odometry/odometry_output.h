#pragma once

#include <filesystem>
#include <span>

#include "core/camera.h"
#include "estimator/odometry/odometry.h"

namespace saccade {

/// Writes into a run folder: trajectory.txt, poses.csv, map.ply (the edges of all keyframes, in the
/// world), depth/, gradient/ and image/ of every keyframe as `saccade run depth` and `reconstruct`
/// write them, views.yaml and keyframes.yaml.
void write_odometry(const std::filesystem::path& folder, const PinholeCamera& camera,
                    const OdometryResult& result, std::span<const Keyframe> keyframes);

}  // namespace saccade
