#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"

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
///
/// An edge that passes a pixel fires several times before it has left it. These events lie on each
/// other when nothing is turned back, and would pull w towards zero (by 4 % where a window is as
/// long as seven pixels), so that only the first of such a burst is taken.
class RotationContrast {
 public:
  /// `camera` with its lens. An event belongs to the burst of the one before at its pixel, of its
  /// polarity, within `burst_share` >= 0 of the window's length. `max_events` > 0 of those that are
  /// left are used, evenly spread.
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

  [[nodiscard]] double middle_s() const { return middle_s_; }  ///< of the window
  /// By how much an event moves, RMS, at 1 rad/s across the viewing direction [px], and at
  /// 1 rad/s^2.
  [[nodiscard]] double px_per_rate() const { return px_per_rate_; }
  [[nodiscard]] double px_per_acceleration() const { return px_per_acceleration_; }
  /// The image of the events at the last evaluate(), smoothed.
  [[nodiscard]] const ImageF& image() const { return image_; }

 private:
  void choose(std::span<const Event> events);
  void set_times();
  void warp(const Parameters& parameters);
  void draw();
  void smooth();

  PinholeCamera camera_;
  UndistortionTable undistortion_;
  std::vector<float> kernel_;  ///< one half of it, the middle first
  double burst_share_;
  std::size_t max_events_;
  int margin_;  ///< of the image around the sensor's pixels
  double middle_s_ = 0;
  double px_per_rate_ = 0, px_per_acceleration_ = 0;
  double rate_per_acceleration_ = 0;  ///< c [s]
  std::vector<float> ray_x_, ray_y_;
  std::vector<float> t_, s_;  ///< [s], [s^2]
  std::vector<float> x_, y_;  ///< in image_; x < 0 where an event leaves it
  ImageF image_, row_sums_;
  std::vector<TimeNs> last_ns_;      ///< of the last event, by pixel and polarity
  std::vector<std::size_t> chosen_;  ///< the first events of bursts
};

}  // namespace saccade
