#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/config/fields.h"
#include "estimator/odometry/odometry.h"
#include "estimator/odometry/start/bootstrap.h"
#include "estimator/run/camera_correction.h"

namespace saccade {

/// What is known of the camera at the start.
struct StartOptions {
  double truth_s = 0.2;         ///< 0: nothing is known
  double truth_fraction = 0.1;  ///< of the events' time, at most
  double time_offset_s = 0;     ///< of the time stamps of the given poses
  BootstrapOptions found;       ///< of truth_s: 0
};

/// The configuration of `saccade run odometry`; describe() names the keys, ranges and defaults.
/// Nothing comes from the dataset but its events, its calibration, the poses of the start, if
/// there are any, and, where asked for, the samples of its inertial sensor.
struct OdometryConfig {
  std::optional<std::filesystem::path> sensor;  ///< sensor.yaml, default of mapping.contrast_*
  CameraCorrection camera;
  StartOptions start;
  std::string method = "edges";  ///< a row of odometry_methods()
  OdometryOptions odometry;      ///< the method's preset where no key says otherwise
  bool align_imu = false;        ///< metric_world.h
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, OdometryConfig& config);

}  // namespace saccade
