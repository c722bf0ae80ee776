#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "estimator/rotation/warped_image.h"

namespace saccade {

/// How a camera turns during a window: its angular velocity in the middle and its angular
/// acceleration, in camera axes.
struct Turning {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< [rad/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< [rad/s^2]
};

/// How sharp the image of a window's events is when they are turned back by a motion (Gallego and
/// Scaramuzza, RA-L 2(2), 2017): with I the image of the events at
///   x_k(p) = pi(exp(t_k w + s_k a) pi^-1(u_k)),   p = (w, a),
/// drawn bilinearly and smoothed by K, the value is sum I^2 over the pixels. Its gradient is
///   d/dp = 2 sum_k grad(K * I)(x_k) dx_k/dp,
/// so that no derivative of the image is drawn. t is the time since the middle of the window and
///   s = t^2 / 2 - c t - d
/// is made orthogonal to 1 and t over the events, so that w and a can be found apart: a is the
/// acceleration, and w - c a the rate in the middle. A shift of all events, as by d, is not seen.
/// The events are chosen by BurstFilter: without it the rate is 4 % low where a window is as long
/// as seven pixels.
class RotationContrast {
 public:
  /// `camera` with its lens; `burst_share` and `max_events` of BurstFilter.
  RotationContrast(const PinholeCamera& camera, double blur_px, double burst_share,
                   std::size_t max_events);

  /// The events of a window, in order of time, at least one.
  void load(std::span<const Event> events);

  using Parameters = Eigen::Matrix<double, 6, 1>;  ///< w [rad/s], a [rad/s^2]
  [[nodiscard]] Parameters parameters_of(const Turning& turning) const;
  [[nodiscard]] Turning turning_of(const Parameters& parameters) const;

  struct Value {
    double contrast = 0;                       ///< per event squared
    Parameters gradient = Parameters::Zero();  ///< by w and a
  };
  [[nodiscard]] Value evaluate(const Parameters& parameters);

  [[nodiscard]] double middle_s() const { return rays_.middle_s; }  ///< of the window
  /// By how much an event moves, RMS, at 1 rad/s across the viewing direction [px], and at
  /// 1 rad/s^2.
  [[nodiscard]] double px_per_rate() const { return px_per_rate_; }
  [[nodiscard]] double px_per_acceleration() const { return px_per_acceleration_; }
  /// The image of the events at the last evaluate(), smoothed.
  [[nodiscard]] const ImageF& image() const { return image_.pixels(); }

 private:
  void set_times();
  void warp(const Parameters& parameters);

  PinholeCamera camera_;
  BurstFilter filter_;
  WarpedImage image_;
  WindowRays rays_;
  double px_per_rate_ = 0, px_per_acceleration_ = 0;
  double rate_per_acceleration_ = 0;  ///< c [s]
  std::vector<float> s_;              ///< [s^2]
  std::vector<float> x_, y_;          ///< in image_; x < 0 where an event leaves it
};

}  // namespace saccade
