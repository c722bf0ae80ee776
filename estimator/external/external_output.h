#pragma once

#include <filesystem>
#include <vector>

#include "core/trajectory.h"
#include "estimator/external/adapter_config.h"

namespace saccade {

/// The poses of `file` as world_from_camera in seconds; an empty file gives none. Throws InputError
/// with `file:line` for malformed lines: NaN, quaternions without unit length, times that do not
/// increase.
[[nodiscard]] std::vector<StampedPose> read_external_trajectory(const std::filesystem::path& file,
                                                                const TrajectoryFormat& format);

/// Copies the results in `out` into the run folder `run`; returns the number of poses. Throws
/// InputError where a result that the adapter states is missing or malformed.
std::size_t import_external_output(const std::filesystem::path& out, const AdapterOutput& output,
                                   const std::filesystem::path& run);

}  // namespace saccade
