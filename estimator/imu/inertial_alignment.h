#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/trajectory.h"
#include "estimator/imu/imu_input.h"
#include "estimator/imu/preintegration.h"

namespace saccade {

/// Between two poses of the path that samples connect [s].
inline constexpr double kInertialInterval_s = 0.1;

/// Scale, gravity and calibration that align a camera's path with inertial measurements.
struct InertialAlignment {
  enum class Status {
    kOk,
    kNoSamples,          ///< the samples cover too little of the path
    kUnobservableScale,  ///< nearly constant velocity: accelerations are too small for the scale
    kInconsistent        ///< path and samples contradict each other, by their stated sigmas
  };

  Status status = Status::kNoSamples;
  double scale = 1;                                   ///< metres in the path's unit
  double scale_sigma = 0;                             ///< relative
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< in the path's world [m/s^2]
  double tilt_sigma_rad = 0;                          ///< of gravity's direction
  ImuBias bias;                                       ///< in the camera's axes
  double time_offset_s = 0;  ///< a sample with stamp t belongs to the path's time t + offset
  std::size_t intervals = 0;
  double residual = 0;  ///< RMS of the whitened residuals; 1 is expected

  /// The shortest rotation of the path's world that makes gravity point along -z.
  [[nodiscard]] Eigen::Quaterniond gravity_alignment() const;
};

/// Scale, gravity, biases and time offset of a path up to scale, by least squares over intervals j
/// (the visual-inertial alignment of Martinelli, and of Qin and Shen, with a time offset). First
/// gyroscope bias b and time offset o from the rotations, which do not depend on the scale,
///   Log(dR(b, o)^T R_j^T R_(j+1)) = 0;                                                      (a)
/// then, with l = 1 / scale, R and p the path's poses, x the sensor's position in the camera, c the
/// accelerometer's bias, g = l (G d + B t), d a unit vector and B a basis of its tangent plane,
///   p_(j+1) - p_j = v_j T + g T^2 / 2 + l (R_j dP(c) - (R_(j+1) - R_j) x)                   (b)
///   v_(j+1) - v_j = g T + l R_j dV(c)                                                       (c)
/// which is linear in l, v_j, l t and l c, and repeated about the new d. The samples, which have
/// the smaller errors, are multiplied by the unknown l: with the path multiplied by the scale
/// instead, noise of the path would bias the scale towards zero. `path`: at least two poses, whose
/// positions have a sigma of a thousandth of `typical_depth_m` (in the path's unit). Deterministic.
[[nodiscard]] InertialAlignment align_inertially(const Trajectory& path, const MountedImu& imu,
                                                 double typical_depth_m,
                                                 double interval_s = kInertialInterval_s);

}  // namespace saccade
