#pragma once

#include <utility>

#include <Eigen/Core>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "core/rigid3.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {

/// What is expected of the motion between two poses.
struct MotionModelOptions {
  enum class Prediction { kNone, kConstantVelocity, kImu };

  Prediction prediction = Prediction::kNone;
  /// The velocity is a random walk (white noise on the acceleration; Barfoot, State Estimation for
  /// Robotics, 3.4): standard deviation of its change within a second, as image motion [px/s].
  double acceleration_sigma_px = 500;
  /// The same per image speed [1/s], added: what moves fast is likely to change direction.
  double acceleration_per_speed = 0;
  double gyro_sigma = 0.05;                             ///< of a reading, its bias included [rad/s]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  ///< sensor frame [rad/s]
  double time_offset_s = 0;
};

void describe(config::Fields& fields, MotionModelOptions& options);

/// The dataset's gyroscope, turned into the frame of the camera by camera.yaml, for
/// motion.prediction: imu; an empty one for any other. InputError where it is needed and missing.
[[nodiscard]] Gyroscope load_gyroscope(const MotionModelOptions& options, const Dataset& dataset);

/// A pose as it is expected, with the inverse of its covariance in the camera frame (v, w).
struct PosePrediction {
  Rigid3 map_from_camera;
  Matrix6 precision = Matrix6::Zero();  ///< zero: nothing is known
};

/// Kalman filter on SE(3) with constant velocity: the error of pose and velocity is Gaussian in the
/// camera frame, the velocity a random walk. The measurement is a pose that the aligner has
/// already pulled towards the prediction by its precision (a maximum a posteriori estimate).
class MotionModel {
 public:
  /// `focal_px` converts image motion into angles.
  MotionModel(const MotionModelOptions& options, double focal_px);

  /// Gyroscope that predicts the rotation of kImu; without it, kImu is constant velocity.
  void set_gyroscope(Gyroscope gyroscope) { gyroscope_ = std::move(gyroscope); }

  /// `sigma_px`: standard deviation of the pose, as image motion.
  void reset(TimeNs t_ns, const Rigid3& map_from_camera, double sigma_px = 0.2);

  /// `depth_m`: typical depth of what is visible, which converts image motion into metres. Moves the
  /// filter to `t_ns`, not before its last time.
  [[nodiscard]] PosePrediction predict(TimeNs t_ns, double depth_m);

  /// Takes in the estimate for the time of the last predict() and what the data alone said about it
  /// (inverse covariance, camera frame).
  void update(const Rigid3& map_from_camera, const Matrix6& information);

  /// Moves the pose within the map; the motion, which is the camera's own, goes on.
  void correct(const Rigid3& map_from_before) {
    map_from_camera_ = map_from_before * map_from_camera_;
  }

  /// Keeps the pose, forgets the velocity: after a frame without information.
  void stop();

  [[nodiscard]] const Rigid3& pose() const { return map_from_camera_; }
  /// Of the pose after the last update(), in the camera's frame (v, w) [m, rad].
  [[nodiscard]] const Matrix6& covariance() const { return pose_covariance_; }
  /// In the camera's frame [m/s, rad/s].
  [[nodiscard]] const Twist& velocity() const { return velocity_; }
  /// The same as image motion at a depth [px/s].
  [[nodiscard]] double speed_px(double depth_m) const {
    return focal_px_ * (velocity_.tail<3>().norm() + velocity_.head<3>().norm() / depth_m);
  }

 private:
  [[nodiscard]] bool has_gyroscope() const;
  void rotate_by_gyroscope(TimeNs from_ns, TimeNs to_ns);
  [[nodiscard]] Eigen::Array<double, 6, 1> twist_of_px(double px, double depth_m) const;

  MotionModelOptions options_;
  Gyroscope gyroscope_;
  double focal_px_;
  TimeNs t_ns_ = 0;
  Rigid3 map_from_camera_;
  Twist velocity_ = Twist::Zero();  ///< camera frame [m/s, rad/s]
  bool velocity_known_ = false;
  double initial_px_ = 0.2;
  Matrix6 pose_covariance_ = Matrix6::Zero();
  Matrix6 cross_covariance_ = Matrix6::Zero();  ///< velocity x pose
  Matrix6 velocity_covariance_ = Matrix6::Zero();
  Matrix6 pose_precision_ = Matrix6::Zero();
};

}  // namespace saccade
