#include "estimator/tracking/motion_model.h"

#include "estimator/imu/imu_input.h"
#include "estimator/tracking/cholesky.h"

namespace saccade {
namespace {

/// Standard deviation at the start: of the velocity nothing is known.
constexpr double kInitialVelocity_px_s = 300;

void describe_gyroscope(config::Fields& fields, MotionModelOptions& options) {
  fields
      .value("gyro_bias", options.gyro_bias,
             "Known bias in rad/s, in the frame of the sensor, which is subtracted from every "
             "reading.")
      .range(-10, 10);
  fields
      .value("time_offset_s", options.time_offset_s,
             "True time of a reading of the gyroscope minus its time stamp, in seconds.")
      .range(-1, 1);
}

}  // namespace

void describe(config::Fields& fields, MotionModelOptions& options) {
  using Prediction = MotionModelOptions::Prediction;
  fields.choice(
      "prediction", options.prediction,
      {{"none", Prediction::kNone},
       {"constant_velocity", Prediction::kConstantVelocity},
       {"imu", Prediction::kImu}},
      "Prediction of the next pose: the last one, a Kalman filter with constant velocity, "
      "or that filter with the rotation of the gyroscope.");
  if (options.prediction == Prediction::kNone) return;
  fields
      .value("acceleration_sigma_px", options.acceleration_sigma_px,
             "Standard deviation of the change of the image velocity, in px/s, within a second; "
             "after t seconds it is sqrt(t) times as large. A smaller one smooths steady motion; a "
             "larger one follows abrupt motion.")
      .range(1, 1e6);
  if (options.prediction == Prediction::kImu) describe_gyroscope(fields, options);
}

Gyroscope load_gyroscope(const MotionModelOptions& options, const Dataset& dataset) {
  if (options.prediction != MotionModelOptions::Prediction::kImu) return {};
  ImuInput imu = load_imu_input(dataset, "motion.prediction: imu");
  for (ImuSample& sample : imu.samples) sample.t_ns += ns_from_seconds(options.time_offset_s);
  return {imu.samples, imu.camera_from_imu, options.gyro_bias};
}

MotionModel::MotionModel(const MotionModelOptions& options, double focal_px)
    : options_(options), focal_px_(focal_px) {}

void MotionModel::reset(TimeNs t_ns, const Rigid3& map_from_camera, double sigma_px) {
  initial_px_ = sigma_px;
  t_ns_ = t_ns;
  map_from_camera_ = map_from_camera;
  stop();
}

void MotionModel::stop() {
  velocity_.setZero();
  velocity_known_ = false;
}

Eigen::Array<double, 6, 1> MotionModel::twist_of_px(double px, double depth_m) const {
  const double angle = px / focal_px_;
  Eigen::Array<double, 6, 1> twist;
  twist << depth_m * angle, depth_m * angle, depth_m * angle, angle, angle, angle;
  return twist;
}

bool MotionModel::has_gyroscope() const {
  return options_.prediction == MotionModelOptions::Prediction::kImu && !gyroscope_.is_empty();
}

void MotionModel::rotate_by_gyroscope(TimeNs from_ns, TimeNs to_ns) {
  // Measured, not estimated: independent of the pose and of the translation.
  velocity_.tail<3>() = gyroscope_.mean_rate(from_ns, to_ns);
  cross_covariance_.bottomRows<3>().setZero();
  velocity_covariance_.bottomRows<3>().setZero();
  velocity_covariance_.rightCols<3>().setZero();
  velocity_covariance_.bottomRightCorner<3, 3>().diagonal().setConstant(options_.gyro_sigma *
                                                                        options_.gyro_sigma);
}

PosePrediction MotionModel::predict(TimeNs t_ns, double depth_m) {
  const double dt = seconds_from_ns(t_ns - t_ns_);
  const TimeNs last_ns = t_ns_;
  t_ns_ = t_ns;
  if (options_.prediction == MotionModelOptions::Prediction::kNone)
    return {map_from_camera_, Matrix6::Zero()};
  if (!velocity_known_) {
    velocity_known_ = true;
    pose_covariance_ = twist_of_px(initial_px_, depth_m).square().matrix().asDiagonal();
    velocity_covariance_ =
        twist_of_px(kInitialVelocity_px_s, depth_m).square().matrix().asDiagonal();
    cross_covariance_.setZero();
  }
  const double acceleration_px =
      options_.acceleration_sigma_px + options_.acceleration_per_speed * speed_px(depth_m);
  Twist drift = twist_of_px(acceleration_px, depth_m).square();
  if (has_gyroscope()) {
    rotate_by_gyroscope(last_ns, t_ns);
    drift.tail<3>().setZero();
  }
  map_from_camera_ = map_from_camera_ * Rigid3::exp(velocity_ * dt);
  pose_covariance_ +=
      dt * (cross_covariance_ + cross_covariance_.transpose()) + dt * dt * velocity_covariance_;
  pose_covariance_.diagonal() += dt * dt * dt / 3 * drift;
  cross_covariance_ += dt * velocity_covariance_;
  cross_covariance_.diagonal() += dt * dt / 2 * drift;
  velocity_covariance_.diagonal() += dt * drift;
  pose_precision_ = inverse_symmetric(pose_covariance_);
  return {map_from_camera_, pose_precision_};
}

void MotionModel::update(const Rigid3& map_from_camera, const Matrix6& information) {
  if (options_.prediction != MotionModelOptions::Prediction::kNone) {
    // Given the pose, the velocity is independent of the measurement: it follows the pose by
    // regression.
    const Matrix6 regression = cross_covariance_ * pose_precision_;
    const Twist error = (map_from_camera_.inverse() * map_from_camera).log();
    velocity_ += regression * error;
    const Matrix6 posterior = inverse_symmetric<6>(pose_precision_ + information);
    velocity_covariance_ -= regression * (pose_covariance_ - posterior) * regression.transpose();
    cross_covariance_ = regression * posterior;
    pose_covariance_ = posterior;
  } else {
    pose_covariance_ = inverse_symmetric<6>(information);
  }
  map_from_camera_ = map_from_camera;
}

}  // namespace saccade
