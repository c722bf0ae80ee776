#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

struct OdometryConfig;

/// `saccade run odometry`: poses and map from events alone and the poses of a short start.
RunSummary run_odometry(const RunRequest& request);

/// The same with this configuration in place of the request's.
RunSummary run_odometry(const RunRequest& request, const OdometryConfig& config);

}  // namespace saccade
