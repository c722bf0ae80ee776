#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run odometry`: poses and map from events alone and the poses of a short start.
RunSummary run_odometry(const RunRequest& request);

}  // namespace saccade
