#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run external`: an external program over a dataset (docs/own_estimator.md). A
/// crash, a time-out and bad output are a status of the run, which then holds no poses; a program
/// that cannot be started is an InputError.
RunSummary run_external(const RunRequest& request);

}  // namespace saccade
