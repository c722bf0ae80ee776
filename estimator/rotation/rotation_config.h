#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/imu/orientation.h"
#include "estimator/rotation/rotation_estimator.h"

namespace saccade {

/// The configuration of `saccade run rotation`; describe() names the keys, ranges and defaults.
struct RotationConfig {
  enum class Source {
    kEvents,  ///< RotationEstimator
    kImu,     ///< the gyroscope without the bias that the orientation filter estimates
    kBoth,    ///< RateFusion of both
  };

  Source source = Source::kEvents;
  RotationOptions events;
  OrientationOptions orientation;  ///< of kImu
  double averaging_s = 0;          ///< of kImu
  GyroscopeNoise gyroscope;        ///< of kBoth
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, RotationConfig& config);

}  // namespace saccade
