#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "estimator/rotation/warped_image.h"

namespace saccade {

/// Rotation of a camera during a window: angular velocity in the middle and constant angular
/// acceleration, in camera axes.
struct AngularMotion {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< [rad/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< [rad/s^2]
};

/// Contrast of the image of warped events as a function of the rotation (contrast maximisation,
/// Gallego and Scaramuzza, RA-L 2(2), 2017): with I the image of the events warped to
///   x_k(p) = pi(exp(t_k w + s_k a) pi^-1(u_k)),   p = (w, a),                               (a)
/// drawn bilinearly and smoothed by a Gaussian K, the contrast is
///   f(p) = sum I^2 over the pixels,                                                         (b)
///   df/dp = 2 sum_k grad(K * I)(x_k) dx_k/dp,                                               (c)
/// so that no derivative image is drawn. t is the time since the middle of the window and
///   s = t^2 / 2 - c t - d                                                                   (d)
/// is orthogonal to 1 and t over the events, which decouples w and a: a is the acceleration, and
/// w the rate at the time c, near the mean of the events' times. The contrast is invariant to a common
/// shift, as by d. BurstFilter selects the events: without it the rate of ideal pixels is 4 % low
/// where a window is seven pixels long.
class RotationContrast {
 public:
  /// `camera` with its lens; `bursts` and `max_events` of BurstFilter.
  RotationContrast(const PinholeCamera& camera, double blur_px, const BurstLimits& bursts,
                   std::size_t max_events);

  /// The events of a window, in order of time, at least one.
  void load(std::span<const Event> events);

  using Parameters = Eigen::Matrix<double, 6, 1>;  ///< w [rad/s], a [rad/s^2]

  struct Value {
    double contrast = 0;                       ///< f / N^2 for N events
    Parameters gradient = Parameters::Zero();  ///< by w and a
  };
  [[nodiscard]] Value evaluate(const Parameters& parameters);

  [[nodiscard]] double middle_s() const { return rays_.middle_s; }  ///< of the window
  /// Of the rate w: the middle + c.
  [[nodiscard]] double reference_s() const { return rays_.middle_s + reference_after_middle_s_; }
  /// RMS displacement of the events at 1 rad/s across the viewing direction [px], and at 1 rad/s^2.
  [[nodiscard]] double px_per_rate() const { return px_per_rate_; }
  [[nodiscard]] double px_per_acceleration() const { return px_per_acceleration_; }
  /// The image of warped events of the last evaluate(), smoothed twice.
  [[nodiscard]] const ImageF& image() const { return image_.pixels(); }

 private:
  void set_times();
  void warp(const Parameters& parameters);

  PinholeCamera camera_;
  BurstFilter filter_;
  WarpedImage image_;
  WindowRays rays_;
  double px_per_rate_ = 0, px_per_acceleration_ = 0;
  double reference_after_middle_s_ = 0;  ///< c
  std::vector<float> s_;                 ///< of each event, by (d) [s^2]
  std::vector<float> x_, y_;             ///< warped, in image_; x < 0 outside
};

}  // namespace saccade
