#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/rotation/rotation_contrast.h"

namespace saccade {

struct RotationOptions {
  int window_events = 80000;
  int min_events = 2000;  ///< a window with fewer has no estimate
  double max_window_s = 0.05;
  int samples = 20000;           ///< events of a window that are used, at most
  double blur_px = 1;            ///< sigma of K
  double burst_fraction = 0.15;  ///< of the window's length, see BurstFilter
};

/// Result of one window.
struct RotationEstimate {
  double t_s = 0;          ///< middle of the window
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

  /// `events`: a window, in order of time, at least one. `guess`: initial motion.
  [[nodiscard]] RotationEstimate estimate(std::span<const Event> events,
                                          const AngularMotion& guess);

  /// The motion of the previous window, extrapolated to `t_s`.
  [[nodiscard]] static AngularMotion predict(const RotationEstimate& last, double t_s);

 private:
  RotationOptions options_;
  RotationContrast contrast_;
};

/// Number of events of the next window: `options.window_events`, or fewer where they last longer than
/// `options.max_window_s`; all that are left if these are fewer than one and a half windows.
[[nodiscard]] std::size_t next_window_size(std::span<const Event> events,
                                           const RotationOptions& options);

}  // namespace saccade
