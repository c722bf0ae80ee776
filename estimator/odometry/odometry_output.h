#pragma once

#include <filesystem>
#include <span>

#include "core/camera.h"
#include "core/io/run/keyframe_list.h"
#include "estimator/odometry/odometry.h"

namespace saccade {

/// Writes of keyframes depth/, views.yaml, keyframes.yaml and map.ply, the edges of all of them in
/// the world, and gradient/ and image/ of those with an image. `camera` is undistorted; `entries`,
/// one for each, say when it was made and used.
void write_keyframes(const std::filesystem::path& folder, const PinholeCamera& camera,
                     std::span<const Keyframe> keyframes, std::span<const KeyframeEntry> entries);

/// Writes into a run folder: trajectory.txt, poses.csv and the keyframes (write_keyframes()).
void write_odometry(const std::filesystem::path& folder, const PinholeCamera& camera,
                    const OdometryResult& result, std::span<const Keyframe> keyframes);

}  // namespace saccade
