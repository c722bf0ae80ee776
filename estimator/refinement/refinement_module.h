#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run refine`: the batch optimum beside a run, as a run folder of the same make with
/// covariance.txt and cost.csv. One thread. Throws InputError for bad input, a run that cannot be
/// refined among it.
RunSummary run_refinement(const RunRequest& request);

}  // namespace saccade
