#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run mosaic`, the rotation camera: a panorama of log intensity from the events of a
/// rotating camera and its orientation, of a dataset's inertial sensor or, with
/// `poses_from`, of another run. Writes mosaic.exr, mosaic.png, mosaic.yaml, orientation.txt,
/// gyro_bias.txt (of the inertial sensor), growth/, run.yaml and timing.json; the same for any
/// number of threads. Throws InputError for bad input.
RunSummary run_mosaic(const RunRequest& request);

}  // namespace saccade
