#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/replica_source.h"
#include "eval/calibration/calibration_page.h"

namespace saccade {

/// What `saccade calibrate` is asked to do.
struct CalibrationRequest {
  std::vector<std::filesystem::path> recordings;  ///< of one sensor, at least one
  std::string name;                               ///< of the sensor
  ReplicaOptions replica;
  bool simulates = true;  ///< else the events alone count
  bool fits_cutoff = false;
  bool fits_mismatch = true;
  /// Folder for a replica of every stretch, with the sensor that was found.
  std::optional<std::filesystem::path> replicas;
  std::uint64_t seed = 1;
};

/// Finds what the recordings tell of their sensor: blind time, noise and hot pixels from the events
/// alone; then, where a replica can be simulated, thresholds, blind time, mismatch and bandwidth by
/// fit_sensor(). Throws InputError for what cannot be read.
[[nodiscard]] CalibrationSummary calibrate(const CalibrationRequest& request);

}  // namespace saccade
