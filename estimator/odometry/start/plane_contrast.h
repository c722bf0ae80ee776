#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/odometry/start/plane_motion.h"
#include "estimator/rotation/warped_image.h"

namespace saccade {

/// Contrast of the image of a window's events that are warped by a PlaneMotion to the
/// camera in the middle of the window. An event with the ray q, at time t, saw the plane at
///   X = o + l R q,  l = (1 - m . o) / (m . R q),  (R, o) = reference_from_camera(t),
/// and is drawn at pi(X); the value is sum I^2 as in RotationContrast. With g the gradient there,
/// G = (d pi / d X)^T g and G' = G - m (R q . G) / (m . R q), the derivatives are
///   by v: t G',   by w: t l J_l(t w)^T (R q x G'),   by m: -X (R q . G) / (m . R q).
/// The middle is where what shrinks before grows afterwards, so that a motion along the viewing
/// direction gains nothing by shrinking the picture, to first order.
class PlaneContrast {
 public:
  /// `camera` with its lens; `bursts` and `max_events` of BurstFilter.
  PlaneContrast(const PinholeCamera& camera, double blur_px, const BurstLimits& bursts,
                std::size_t max_events);

  /// The events of a window, in order of time, at least one.
  void load(std::span<const Event> events);

  using Parameters = Eigen::Matrix<double, 8, 1>;  ///< v [1/s], w [rad/s], slope [-]
  [[nodiscard]] static Parameters parameters_of(const PlaneMotion& motion);
  [[nodiscard]] static PlaneMotion motion_of(const Parameters& parameters);

  struct Value {
    double contrast = 0;  ///< per event squared
    Parameters gradient = Parameters::Zero();
  };
  [[nodiscard]] Value evaluate(const Parameters& parameters);

  [[nodiscard]] double middle_s() const { return rays_.middle_s; }  ///< of the window
  /// By how much an event moves, RMS, at 1 rad/s across the viewing direction [px].
  [[nodiscard]] double px_per_rate() const { return px_per_rate_; }
  [[nodiscard]] const ImageF& image() const { return image_.pixels(); }

 private:
  void warp(const PlaneMotion& motion);

  PinholeCamera camera_;  ///< undistorted
  BurstFilter filter_;
  WarpedImage image_;
  WindowRays rays_;
  double px_per_rate_ = 0;
  std::vector<float> x_, y_;                ///< in image_; x < 0 where an event leaves it
  std::vector<Eigen::Vector3f> rotated_;    ///< R q
  std::vector<Eigen::Vector3f> in_middle_;  ///< X
};

}  // namespace saccade
