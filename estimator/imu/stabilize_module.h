#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run stabilize`: orientation from a dataset's inertial sensor or, with `poses_from`,
/// from another run; events and grey frames rotated to a smoothed orientation. Writes orientation.txt,
/// gyro_bias.txt (of the inertial sensor), stabilized/ (events.h5, places.h5, windows.csv, frames/,
/// images.txt), run.yaml and timing.json. Events and frames are optional. Throws
/// InputError for bad input.
RunSummary run_stabilization(const RunRequest& request);

}  // namespace saccade
