#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/odometry/odometry.h"

namespace saccade {

/// What is known of the camera at the start.
struct StartOptions {
  double truth_s = 0.2;      ///< the ground truth is given for so long from the first event on
  double truth_share = 0.1;  ///< ... but for no more than this share of the events' time
};

/// The configuration of `saccade run odometry`; describe() names the keys, ranges and defaults.
/// Nothing comes from the dataset but its events, its calibration and the poses of the start.
struct OdometryConfig {
  StartOptions start;
  OdometryOptions odometry;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, OdometryConfig& config);

}  // namespace saccade
