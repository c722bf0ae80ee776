#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/imu_sample.h"
#include "core/io/dataset/dataset.h"
#include "core/io/run/run_record.h"
#include "core/trajectory.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/command_template.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// What an external program receives.
struct ExternalInput {
  Placeholders values;       ///< without those of AdapterConfig::files
  RunRecord::Window window;  ///< to be scored: after the given true poses
};

/// The true poses from `from_s` to `from_s + truth_s`, and the one before. Throws
/// InputError where there is none.
[[nodiscard]] Trajectory groundtruth_start(const Dataset& dataset, double from_s, double truth_s);

/// The inertial samples of the window; InputError where the dataset has none.
[[nodiscard]] std::vector<ImuSample> imu_window(const RunRequest& request, const Dataset& dataset,
                                                std::span<const Event> events);

/// Writes events and calibration into `folder`, and what else the adapter's placeholders ask for: the
/// start of the ground truth, inertial samples. Times are those of the dataset. The folder contains
/// no ground truth beside that start.
[[nodiscard]] ExternalInput write_external_input(const std::filesystem::path& folder,
                                                 const AdapterConfig& config,
                                                 const RunRequest& request, const Dataset& dataset,
                                                 std::span<const Event> events);

}  // namespace saccade
