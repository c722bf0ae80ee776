#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run track`: follows the camera against the map of one reference frame and writes
/// trajectory.txt, poses.csv, map.ply, run.yaml and timing.json. One thread. Throws InputError for
/// bad input; lost tracking is a status in poses.csv.
RunSummary run_track(const RunRequest& request);

}  // namespace saccade
