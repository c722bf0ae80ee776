#pragma once

#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/rotation/rotation_contrast.h"

namespace saccade {

struct RotationOptions {
  int events = 80000;          ///< per window
  int min_events = 2000;       ///< fewer say nothing
  double max_window_s = 0.05;  ///< a slow window is cut here
  int samples = 20000;         ///< at most so many of them are used
  double blur_px = 1;          ///< of the image of events
  double burst_share = 0.15;   ///< of the window's length, see RotationContrast
  int iterations = 30;         ///< of quasi-Newton steps, at most
  double tolerance_px = 0.01;  ///< a step that moves events by less is the last
};

/// What one window says.
struct RotationEstimate {
  double t_s = 0;          ///< middle of the window
  Turning turning;         ///< then
  double contrast = 0;     ///< reached
  double px_per_rate = 0;  ///< by how much the events move at 1 rad/s, RMS [px]
  int iterations = 0;
  bool is_valid = false;
};

/// Angular velocity from events alone, window by window, by the contrast of the turned events
/// (rotation_contrast.h), with BFGS from the rate of the window before. Deterministic.
class RotationEstimator {
 public:
  RotationEstimator(const PinholeCamera& camera, const RotationOptions& options);

  /// `events`: a window, in order of time, at least one. `guess`: where the search starts.
  [[nodiscard]] RotationEstimate estimate(std::span<const Event> events, const Turning& guess);

  /// Where the search begins at `t_s`, if `last` came before it.
  [[nodiscard]] static Turning predict(const RotationEstimate& last, double t_s);

 private:
  RotationOptions options_;
  RotationContrast contrast_;
};

/// The events of the next window: `options.events`, or fewer where they take too long; all that are
/// left where these are not half as many more.
[[nodiscard]] std::size_t next_window(std::span<const Event> events,
                                      const RotationOptions& options);

}  // namespace saccade
