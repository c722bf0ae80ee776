#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/io/dataset.h"
#include "core/io/run_record.h"
#include "core/trajectory.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/command_template.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// What an external program gets of a dataset.
struct Handover {
  Placeholders values;       ///< all but those that AdapterConfig::files names
  RunRecord::Window window;  ///< that is scored: after the true poses that were handed over
};

/// The true poses of the first `groundtruth_start_s` from `from_s` on, and the one before. Throws
/// InputError where there is none.
[[nodiscard]] Trajectory groundtruth_start(const Dataset& dataset, double from_s,
                                           double groundtruth_start_s);

/// Writes into `folder` the events and the calibration, and what else the adapter's words ask for:
/// the start of the ground truth, inertial readings. Times stay those of the dataset. Nothing in
/// the folder tells more of the truth than that start.
[[nodiscard]] Handover write_handover(const std::filesystem::path& folder,
                                      const AdapterConfig& config, const RunRequest& request,
                                      const Dataset& dataset, std::span<const Event> events);

}  // namespace saccade
