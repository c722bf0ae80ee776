#pragma once

#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run reconstruct`: gradient and log intensity of views of a dataset, with the poses of
/// the ground truth or of another run and the dataset's depth or that of a depth run. Writes
/// gradient/, image/, growth/, figures/, views.yaml, run.yaml and timing.json. Windows run in
/// parallel, with the same result for any number of threads. Throws InputError for bad input.
RunSummary run_reconstruction(const RunRequest& request);

}  // namespace saccade
