#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/rigid3.h"
#include "estimator/tracking/map_extraction.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// Writes trajectory.txt and poses.csv into a run folder.
void write_poses(const std::filesystem::path& folder, std::span<const TrackedPose> poses);

/// Writes the map that was tracked as a cloud in the world.
void write_map(const std::filesystem::path& file, const MapPoints& map,
               const Rigid3& world_from_map);

[[nodiscard]] std::size_t count_lost(std::span<const TrackedPose> poses);

}  // namespace saccade
