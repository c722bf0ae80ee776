#pragma once

#include "core/io/dataset/dataset.h"
#include "estimator/refinement/refinement_config.h"
#include "estimator/refinement/source_run.h"
#include "estimator/run/run_writer.h"

namespace saccade {

/// Points of a run of depth: writes depth/, keypoints/, views.yaml and cloud.ply as `saccade run
/// depth` does, and cost.csv, whose rounds are the views.
RunSummary refine_depth(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer);

}  // namespace saccade
