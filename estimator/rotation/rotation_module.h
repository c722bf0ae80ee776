#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/imu/orientation.h"
#include "estimator/rotation/rotation_estimator.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// The configuration of `saccade run rotation`; describe() names the keys, ranges and defaults.
struct RotationConfig {
  enum class Method {
    kEvents,  ///< RotationEstimator
    kImu,     ///< the gyroscope without the bias that the orientation filter estimates
    kBoth,    ///< RateFusion of both
  };

  Method method = Method::kEvents;
  RotationOptions events;
  OrientationOptions orientation;  ///< of kImu
  double averaging_s = 0;          ///< of kImu
  GyroscopeNoise gyroscope;        ///< of kBoth
  std::uint64_t seed = 1;

  RotationConfig() { orientation.method = OrientationOptions::Method::kInertial; }
};

void describe(config::Fields& fields, RotationConfig& config);

/// `saccade run rotation`: the camera's angular velocity from events alone, from its gyroscope, or
/// from both. Writes angular_velocity.txt, run.yaml and timing.json. Throws InputError for bad
/// input.
RunSummary run_rotation(const RunRequest& request);

}  // namespace saccade
