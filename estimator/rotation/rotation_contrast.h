#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"

namespace saccade {

/// How sharp the image of a window's events is when they are turned back by an angular velocity
/// (Gallego and Scaramuzza, RA-L 2(2), 2017): with I the image of the events at
///   x_k(w) = pi(exp((t_k - t) w) pi^-1(u_k)),   t the middle of the window,
/// drawn bilinearly and smoothed by K, the value is sum I^2 over the pixels. Its gradient is
///   d/dw = 2 sum_k grad(K * I)(x_k) dx_k/dw,
/// so that no derivative of the image is drawn.
class RotationContrast {
 public:
  /// `camera` with its lens. `max_events` > 0 of a window are used, evenly spread.
  RotationContrast(const PinholeCamera& camera, double blur_px, std::size_t max_events);

  /// The events of a window, in order of time, at least one.
  void load(std::span<const Event> events);

  struct Value {
    double contrast = 0;                                 ///< per event squared
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< by w [s/rad]
  };
  /// `w`: angular velocity in camera axes [rad/s].
  [[nodiscard]] Value evaluate(const Eigen::Vector3d& w);

  [[nodiscard]] double middle_s() const { return middle_s_; }  ///< of the window
  /// By how much an event moves on the average at 1 rad/s across the viewing direction [px].
  [[nodiscard]] double px_per_rate() const { return px_per_rate_; }
  /// The image of the events at the last evaluate(), smoothed.
  [[nodiscard]] const ImageF& image() const { return image_; }

 private:
  void warp(const Eigen::Vector3d& w);
  void draw();
  void smooth();

  PinholeCamera camera_;
  UndistortionTable undistortion_;
  std::vector<float> kernel_;  ///< one half of it, the middle first
  std::size_t max_events_;
  int margin_;  ///< of the image around the sensor's pixels
  double middle_s_ = 0;
  double px_per_rate_ = 0;
  std::vector<float> ray_x_, ray_y_, time_s_;
  std::vector<float> x_, y_;  ///< in image_; x < 0 where an event leaves it
  ImageF image_, row_sums_;
};

}  // namespace saccade
