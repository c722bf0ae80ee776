#pragma once

#include <cstdint>
#include <optional>

#include "core/config/fields.h"
#include "estimator/refinement/depth_refinement.h"
#include "estimator/refinement/joint_refinement.h"
#include "estimator/refinement/pose_refinement.h"

namespace saccade {

/// The configuration of `saccade run refine`; describe() names the keys, ranges and defaults.
struct RefinementConfig {
  /// What is refined: kOfRun follows the run's module.
  enum class Kind { kOfRun, kPoses, kDepth, kJoint };

  Kind kind = Kind::kOfRun;
  PoseRefinementOptions poses;
  DepthRefinementOptions depth;
  JointRefinementOptions joint;
  IntensityMapOptions map;
  std::optional<double> turn_deg;  ///< further views of the map; default: those of the run
  std::optional<double> contrast;  ///< [log units]; default: the run's, else the dataset's
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, RefinementConfig& config);

}  // namespace saccade
