#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/imu/orientation.h"
#include "estimator/imu/orientation_smoothing.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// The configuration of `saccade run stabilize`; describe() names the keys, ranges and defaults.
struct StabilizeConfig {
  OrientationOptions orientation;
  SmoothingOptions smoothing;
  double window_s = 0.1;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, StabilizeConfig& config);

/// `saccade run stabilize`: orientation from a dataset's inertial sensor or, with `poses_from`,
/// from another run; events and grey frames rotated to a smoothed orientation. Writes orientation.txt,
/// gyro_bias.txt (of the inertial sensor), stabilized/ (events.h5, places.h5, windows.csv, frames/,
/// images.txt), run.yaml and timing.json. Events and frames are optional. Throws
/// InputError for bad input.
RunSummary run_stabilization(const RunRequest& request);

}  // namespace saccade
