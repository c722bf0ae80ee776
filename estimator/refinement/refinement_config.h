#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/config/fields.h"
#include "core/io/dataset/dataset.h"
#include "estimator/edges/path/batch_adjustment.h"
#include "estimator/refinement/poses/pose_refinement.h"
#include "estimator/refinement/source_run.h"
#include "estimator/run/run_writer.h"

namespace saccade {

/// The configuration of `saccade run refine`; describe() names the keys, ranges and defaults.
struct RefinementConfig {
  std::string method = "of_run";  ///< a row of refinement_methods()
  PoseRefinementOptions poses;
  /// [log units]; default: the run's, else the dataset's.
  std::optional<double> contrast_on, contrast_off;
  BatchAdjustmentOptions joint;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, RefinementConfig& config);

/// One way to refine a run, as a row of core/config/method_table.h.
struct RefinementMethod {
  std::string_view name;  ///< value of `method`, and name of the section of its options
  std::string_view help;
  void (*describe)(config::Fields&, RefinementConfig&);
  std::string_view module;  ///< whose runs it refines
  RunSummary (*run)(const RunRequest&, const RefinementConfig&, const Dataset&, const SourceRun&,
                    RunWriter&);
};

[[nodiscard]] std::span<const RefinementMethod> refinement_methods();

/// Poses of a run of track: writes trajectory.txt, poses.csv, map.ply, covariance.txt and cost.csv.
RunSummary refine_poses(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer);

/// Points of a run of depth: writes depth/, keypoints/, views.yaml and cloud.ply as `saccade run
/// depth` does, and cost.csv, whose rounds are the views.
RunSummary refine_depth(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer);

/// Path and map of a run of odometry (adjust_batch()): writes trajectory.txt, poses.csv,
/// covariance.txt, cost.csv, and of every keyframe of the run the depth on the refined path, with
/// views.yaml, keyframes.yaml and map.ply.
RunSummary refine_joint(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer);

}  // namespace saccade
