#pragma once

#include <filesystem>
#include <span>

#include "core/camera.h"
#include "core/io/run/keyframe_list.h"
#include "estimator/odometry/odometry.h"
#include "estimator/odometry/start/bootstrap.h"

namespace saccade {

/// Writes of keyframes depth/, views.yaml, keyframes.yaml and map.ply, the edges of all of them in
/// the world, and gradient/ and image/ of those with an image. `camera` is undistorted; `entries`,
/// one for each, say when it was made and used.
void write_keyframes(const std::filesystem::path& folder, const PinholeCamera& camera,
                     std::span<const Keyframe> keyframes, std::span<const KeyframeEntry> entries);

/// Writes into a run folder: trajectory.txt, poses.csv and the keyframes (write_keyframes()).
void write_odometry(const std::filesystem::path& folder, const PinholeCamera& camera,
                    const OdometryResult& result, std::span<const Keyframe> keyframes);

/// Writes start.yaml: what a start that was found from events alone rests on. `depth_m` is what its
/// typical depth was called.
void write_start(const std::filesystem::path& file, const Bootstrap& start, double depth_m);

}  // namespace saccade
