#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run rotation`: the camera's angular velocity from events alone, from its gyroscope, or
/// from both. Writes angular_velocity.txt, run.yaml and timing.json. Throws InputError for bad
/// input.
RunSummary run_rotation(const RunRequest& request);

}  // namespace saccade
