#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/external/adapter_config.h"

namespace saccade {

/// The poses of `file` as world_from_camera in seconds; an empty file gives none. Throws InputError
/// with `file:line` for malformed lines: NaN, quaternions without unit length, times that do not
/// increase.
[[nodiscard]] std::vector<StampedPose> read_external_trajectory(const std::filesystem::path& file,
                                                                const TrajectoryFormat& format);

/// What a program left.
struct ExternalFound {
  std::optional<std::size_t> poses;  ///< nullopt: of a simulator
  std::size_t events = 0;            ///< of a simulator
};

/// Copies the results in `out` into the run folder `run`, events as events.h5 of the camera's sensor.
/// Throws InputError where a result that the adapter states is missing or malformed.
ExternalFound import_external_output(const std::filesystem::path& out, const AdapterOutput& output,
                                     const PinholeCamera& camera, const std::filesystem::path& run);

/// The results of a program that failed: no pose, or of a simulator no event.
ExternalFound write_no_output(const AdapterOutput& output, const PinholeCamera& camera,
                              const std::filesystem::path& run);

}  // namespace saccade
