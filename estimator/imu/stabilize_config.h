#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/imu/orientation.h"
#include "estimator/imu/orientation_smoothing.h"

namespace saccade {

/// The configuration of `saccade run stabilize`; describe() names the keys, ranges and defaults.
struct StabilizeConfig {
  OrientationOptions orientation;
  SmoothingOptions smoothing;
  double window_s = 0.1;
  bool frames = true;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, StabilizeConfig& config);

}  // namespace saccade
