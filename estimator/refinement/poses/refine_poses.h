#pragma once

#include "core/io/dataset/dataset.h"
#include "estimator/refinement/refinement_config.h"
#include "estimator/refinement/source_run.h"
#include "estimator/run/run_writer.h"

namespace saccade {

/// Poses of a run of track: writes trajectory.txt, poses.csv, map.ply, covariance.txt and cost.csv.
RunSummary refine_poses(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer);

}  // namespace saccade
