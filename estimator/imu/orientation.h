#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/config/fields.h"
#include "core/imu_sample.h"
#include "estimator/imu/complementary_filter.h"
#include "estimator/imu/inertial_bank.h"

namespace saccade {

struct OrientationOptions {
  enum class Method {
    kSmoothed,       ///< InertialBank in both directions of time
    kInertial,       ///< InertialBank
    kComplementary,  ///< ComplementaryFilter
    kGyroscope,      ///< integral of the measured rate, from the tilt of the first sample
  };

  Method method = Method::kSmoothed;
  GyroscopeNoise gyroscope;
  InertialFilterOptions inertial;
  ComplementaryOptions complementary;
};

void describe(config::Fields& fields, GyroscopeNoise& noise);
void describe(config::Fields& fields, OrientationOptions& options);

/// Estimate after one sample.
struct ImuOrientation {
  Eigen::Quaterniond world_from_imu;  ///< the world's z axis points up
  Eigen::Quaterniond continuous;      ///< the same without jumps, where the filter's has any
  GyroBiasEstimate gyro;
};

/// One estimate per sample; `samples` are in order of time.
[[nodiscard]] std::vector<ImuOrientation> estimate_orientations(std::span<const ImuSample> samples,
                                                                const OrientationOptions& options);

}  // namespace saccade
