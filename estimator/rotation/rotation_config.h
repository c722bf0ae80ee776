#pragma once

#include <cstdint>

#include "core/config/fields.h"
#include "estimator/imu/orientation.h"
#include "estimator/rotation/rate_fusion.h"
#include "estimator/rotation/rotation_estimator.h"

namespace saccade {

/// The configuration of `saccade run rotation`; describe() names the keys, ranges and defaults.
struct RotationConfig {
  enum class Source {
    kEvents,  ///< RotationEstimator
    kImu,     ///< the gyroscope without the bias that the orientation filter finds
    kBoth,    ///< RateFusion of both
  };

  Source source = Source::kEvents;
  RotationOptions events;
  OrientationOptions orientation;  ///< of kImu
  double average_s = 0;            ///< of kImu: over which the readings are averaged
  RateFusionOptions fusion;        ///< of kBoth
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, RotationConfig& config);

}  // namespace saccade
