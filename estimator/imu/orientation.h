#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/config/fields.h"
#include "core/imu_sample.h"
#include "estimator/imu/complementary_filter.h"
#include "estimator/imu/inertial_filter.h"

namespace saccade {

struct OrientationOptions {
  enum class Method {
    kInertial,       ///< InertialFilter
    kComplementary,  ///< ComplementaryFilter
    kGyroscope,      ///< the integral of what the gyroscope reads, from the first tilt on
  };

  Method method = Method::kInertial;
  InertialOptions inertial;
  ComplementaryOptions complementary;
};

void describe(config::Fields& fields, GyroscopeNoise& noise);
void describe(config::Fields& fields, OrientationOptions& options);

/// At one reading.
struct ImuOrientation {
  Eigen::Quaterniond world_from_imu;  ///< the world's z axis points up
  GyroBiasEstimate gyro;
};

/// After each of the readings, which are in order of time.
[[nodiscard]] std::vector<ImuOrientation> estimate_orientations(std::span<const ImuSample> samples,
                                                                const OrientationOptions& options);

}  // namespace saccade
