#include "estimator/tracking/motion_model.h"

namespace saccade {

void MotionModel::reset(TimeNs t_ns, const Rigid3& map_from_camera) {
  t_ns_ = t_ns;
  map_from_camera_ = map_from_camera;
  velocity_.setZero();
}

Rigid3 MotionModel::predict(TimeNs t_ns) const {
  if (options_.prediction == PredictionOptions::Prediction::kNone) return map_from_camera_;
  return map_from_camera_ * Rigid3::exp(velocity_ * seconds_from_ns(t_ns - t_ns_));
}

Rigid3 MotionModel::update(TimeNs t_ns, const Rigid3& measured_map_from_camera) {
  const double dt_s = seconds_from_ns(t_ns - t_ns_);
  const Rigid3 predicted = predict(t_ns);
  const Twist deviation = (predicted.inverse() * measured_map_from_camera).log();
  map_from_camera_ = predicted * Rigid3::exp(options_.pose_gain * deviation);
  if (dt_s > 0) velocity_ += options_.velocity_gain / dt_s * deviation;
  t_ns_ = t_ns;
  return map_from_camera_;
}

}  // namespace saccade
