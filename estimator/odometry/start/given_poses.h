#pragma once

#include "core/io/dataset/dataset.h"
#include "core/trajectory.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// The poses that a start is given: those recorded between two times [s], and the last one before
/// `from_s` where none is at it, `offset_s` added to their stamps, smoothed where the request asks
/// for it. Nothing beyond `until_s` is used, not even by the smoothing. May be empty. Throws
/// InputError where the request and the dataset name no poses.
[[nodiscard]] Trajectory given_start(const RunRequest& request, const Dataset& dataset,
                                     double from_s, double until_s, double offset_s);

}  // namespace saccade
