#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/io/covariance_file.h"
#include "core/trajectory.h"
#include "estimator/external/adapter_config.h"

namespace saccade {

/// The poses of `file` as world_from_camera in seconds. InputError with `file:line` for whatever is
/// malformed: NaN, quaternions whose length is off 1, times that do not increase. No poses at all
/// are none.
[[nodiscard]] std::vector<StampedPose> read_external_trajectory(const std::filesystem::path& file,
                                                                const TrajectoryFormat& format);

/// Takes what the program left in `out` into the run folder `run`; how many poses there are.
/// InputError where something that the adapter promises is missing or malformed.
std::size_t import_external_output(const std::filesystem::path& out, const AdapterOutput& output,
                                   const std::filesystem::path& run);

}  // namespace saccade
