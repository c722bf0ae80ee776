#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/odometry/metric_world.h"
#include "estimator/odometry/odometry.h"
#include "estimator/odometry/start/bootstrap.h"
#include "estimator/run/camera_correction.h"

namespace saccade {

/// What is known of the camera at the start.
struct StartOptions {
  /// The ground truth is given for so long from the first event on; 0: nothing is known.
  double truth_s = 0.2;
  double truth_share = 0.1;  ///< ... but for no more than this share of the events' time
  double time_offset_s = 0;  ///< a given pose is that of so long after its time stamp
  BootstrapOptions found;    ///< of truth_s: 0
};

/// The configuration of `saccade run odometry`; describe() names the keys, ranges and defaults.
/// Nothing comes from the dataset but its events, its calibration, the poses of the start, if
/// there are any, and, where asked for, the readings of its inertial sensor.
struct OdometryConfig {
  CameraCorrection camera;
  StartOptions start;
  OdometryOptions odometry;
  MetricWorldOptions metric;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, OdometryConfig& config);

}  // namespace saccade
