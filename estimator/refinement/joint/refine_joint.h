#pragma once

#include "core/io/dataset/dataset.h"
#include "estimator/refinement/refinement_config.h"
#include "estimator/refinement/source_run.h"
#include "estimator/run/run_writer.h"

namespace saccade {

/// Path and map of a run of odometry (adjust_batch()): writes trajectory.txt, poses.csv, covariance.txt, cost.csv,
/// and of every keyframe of the run the depth on the refined path, with views.yaml, keyframes.yaml
/// and map.ply.
RunSummary refine_joint(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer);

}  // namespace saccade
