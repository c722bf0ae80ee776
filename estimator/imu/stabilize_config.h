#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/imu/orientation.h"
#include "estimator/imu/steady_pose.h"

namespace saccade {

/// The configuration of `saccade run stabilize`; describe() names the keys, ranges and defaults.
struct StabilizeConfig {
  OrientationOptions orientation;
  SteadyPoseOptions steady;
  double window_s = 0.1;  ///< events of this time are turned to one orientation
  bool frames = true;     ///< grey frames are stabilized, too
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, StabilizeConfig& config);

}  // namespace saccade
