#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run depth`: depths of edge points in consecutive windows of a dataset, with the poses of
/// the ground truth or of another run. Writes depth/, keypoints/, cloud.ply, views.yaml, run.yaml
/// and timing.json. Windows run in parallel, with the same result for any number of threads. Throws
/// InputError for bad input.
RunSummary run_depth(const RunRequest& request);

}  // namespace saccade
