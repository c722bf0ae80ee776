#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/trajectory.h"
#include "estimator/imu/mounted_imu.h"
#include "estimator/imu/preintegration.h"

namespace saccade {

struct InertialAlignmentOptions {
  double gravity = 9.81;          ///< [m/s^2]
  double interval_s = 0.1;        ///< readings are summed up over so long
  double smoothing_s = 0.05;      ///< spacing of the knots of a spline through the path
  double position_sigma = 5e-4;   ///< of a position of the path [its unit]
  double tilt_sigma_rad = 2e-3;   ///< of an orientation of the path
  double accel_bias_sigma = 0.2;  ///< [m/s^2]
  double max_scale_sigma = 0.05;  ///< relative; a scale that is known less is not known
  double max_residual = 2;        ///< of a path that the readings agree with
  double outlier = 3;             ///< deviations beyond which an interval counts less (Cauchy)
};

/// How a camera's path lies among what an inertial sensor felt.
struct InertialAlignment {
  enum class Status {
    kOk,
    kNoReadings,  ///< the readings do not cover enough of the path
    kEvenMotion,  ///< accelerations are too small to say how long a metre is
    kDisagrees    ///< the path is not the one that the sensor felt, to its stated deviations
  };

  Status status = Status::kNoReadings;
  double scale = 1;                                   ///< metres in the path's unit
  double scale_sigma = 0;                             ///< relative deviation
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< in the path's world [m/s^2]
  double tilt_sigma_rad = 0;                          ///< of gravity's direction
  ImuBias bias;                                       ///< in the camera's axes
  double time_offset_s = 0;  ///< a reading stamped t was taken at the path's time t + offset
  std::size_t intervals = 0;
  double residual = 0;  ///< deviation of what the sensor says, over what was expected

  /// Turns the path's world so that gravity points along -z, the shortest way.
  [[nodiscard]] Eigen::Quaterniond level() const;
};

/// Scale, gravity, biases and time offset of a path up to scale, by least squares over intervals
/// j of its time. Turns first, nothing of which depends on scale,
///   Log(Q(b, o)^T R_j^T R_(j+1)) = 0
/// by gyroscope bias b and time offset o; then, with l = 1 / scale, in the path's unit, R, p its
/// poses, x the sensor's place, c the accelerometer's bias, and g = l (G d + B t), d a unit vector
/// and B across it,
///   p_(j+1) - p_j = v_j T + g T^2 / 2 + l (R_j P(c) - (R_(j+1) - R_j) x)
///   v_(j+1) - v_j = g T + l R_j V(c)
/// which is linear in l, v_j, l t and l c, and repeated about the new d. The readings, which have
/// the smaller errors, stand on the right, with the unknown l: the other way round noise of the
/// path would make the scale too small. `path`: at least two poses. Deterministic.
[[nodiscard]] InertialAlignment align_inertially(const Trajectory& path, const MountedImu& imu,
                                                 const InertialAlignmentOptions& options);

}  // namespace saccade
