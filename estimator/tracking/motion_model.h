#pragma once

#include "core/event.h"
#include "core/rigid3.h"

namespace saccade {

/// What is expected of the motion between two poses.
struct PredictionOptions {
  enum class Prediction { kNone, kConstantVelocity };

  Prediction prediction = Prediction::kNone;
  double pose_gain =
      1;  ///< share of a measured deviation from the prediction that is believed, 0..1
  double velocity_gain = 0.3;  ///< the same for the velocity, 0..1
};

/// Predicts the pose of the next frame; with constant velocity an alpha-beta filter on SE(3).
class MotionModel {
 public:
  explicit MotionModel(const PredictionOptions& options) : options_(options) {}

  void reset(TimeNs t_ns, const Rigid3& map_from_camera);
  [[nodiscard]] Rigid3 predict(TimeNs t_ns) const;
  /// Takes in a measured pose at a later time; returns the filtered one.
  Rigid3 update(TimeNs t_ns, const Rigid3& measured_map_from_camera);
  /// Forgets the velocity.
  void stop() { velocity_.setZero(); }

  [[nodiscard]] const Rigid3& pose() const { return map_from_camera_; }

 private:
  PredictionOptions options_;
  TimeNs t_ns_ = 0;
  Rigid3 map_from_camera_;
  Twist velocity_ = Twist::Zero();  ///< in the camera frame [m/s, rad/s]
};

}  // namespace saccade
