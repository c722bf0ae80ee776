#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/rotation/rotation_contrast.h"

namespace saccade {

struct RotationOptions {
  int window_events = 80000;
  int min_events = 2000;  ///< a window with fewer has no estimate
  /// A window of fewer than `window_events` lasts at least `min_window_s`, and longer while the image
  /// has moved by less than `window_motion_px`: of a slow turn a short window tells nothing but the
  /// grid of the pixels. Within `max_window_s` a hand hardly changes a slow turn.
  double min_window_s = 0.05;
  double max_window_s = 0.25;
  double window_motion_px = 7;
  int samples = 20000;  ///< events of a window that are used, at most
  double blur_px = 1;   ///< sigma of K
  /// Where a pixel fires on and on, one event in each of these lengths is used: all of a slow, rich
  /// texture would otherwise be one burst.
  BurstLimits bursts{.gap = 0.2, .longest = 0.2};
};

/// Result of one window.
struct RotationEstimate {
  double t_s = 0;          ///< near the mean time of the window's events (RotationContrast)
  AngularMotion turning;   ///< there
  double contrast = 0;     ///< at the maximum
  double px_per_rate = 0;  ///< RMS displacement of the events at 1 rad/s [px]
  int iterations = 0;
  bool is_valid = false;
};

/// Angular velocity from events alone, window by window, by contrast maximisation
/// (rotation_contrast.h) with BFGS, from the motion of the previous window. Deterministic.
class RotationEstimator {
 public:
  RotationEstimator(const PinholeCamera& camera, const RotationOptions& options);

  /// `events`: a window, in order of time, at least one. `guess`: initial motion in the middle.
  [[nodiscard]] RotationEstimate estimate(std::span<const Event> events,
                                          const AngularMotion& guess);

  /// The motion of the previous window, extrapolated to `t_s`.
  [[nodiscard]] static AngularMotion predict(const RotationEstimate& last, double t_s);

 private:
  RotationOptions options_;
  RotationContrast contrast_;
};

/// Time in which the image of a camera that turns at `rate` [rad/s] moves by
/// `options.window_motion_px`, RMS over the image, within the bounds of a window's duration [s].
[[nodiscard]] double window_duration(const PinholeCamera& camera, const Eigen::Vector3d& rate,
                                     const RotationOptions& options);

/// Number of events of the next window: `options.window_events`, or fewer where they last longer than
/// `duration_s`; all that are left if these are fewer, or last less, than one and a half windows.
[[nodiscard]] std::size_t next_window_size(std::span<const Event> events, double duration_s,
                                           const RotationOptions& options);

/// Number of events from the start of a window to that of the next one. The slope of the least-squares
/// line through angles over a time T weighs the true rate by a parabola, as wide as a mean over
/// sqrt(0.6) T: windows begin so far apart, and their rates tile the time.
[[nodiscard]] std::size_t window_step(std::span<const Event> window);

}  // namespace saccade
