#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/odometry/start/plane_contrast.h"
#include "estimator/odometry/start/plane_motion.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {

/// A motion before a plane that explains a window.
struct PlaneFit {
  PlaneMotion motion;
  double start_s = 0, middle_s = 0, end_s = 0;  ///< of the window; `motion` is of the middle
  double motion_px = 0;                         ///< of the image over the window, RMS
  double gain = 0;                              ///< contrast over that of events where they fired
};

/// Explains the first events by motions before a plane that maximise PlaneContrast. The window
/// grows: first a rotation, which hardly any window is too short for; then, at several px, rotation
/// and translation in several proportions, because a short window does not distinguish them. Where
/// a gyroscope measures the rotation, it is fixed and the rest of the image motion is translation.
/// Deterministic.
class PlaneSearch {
 public:
  /// A motion that is slow ends at `max_window_s`. `gyroscope`: none where it is empty; outlives it.
  PlaneSearch(double max_window_s, const PinholeCamera& camera, const Gyroscope& gyroscope);

  /// From the first of `events` on; the sharpest first, none where nothing moves.
  [[nodiscard]] std::vector<PlaneFit> find(std::span<const Event> events);

 private:
  [[nodiscard]] std::span<const Event> window(std::span<const Event> events,
                                              double duration_s) const;
  [[nodiscard]] Eigen::Vector3d measured_rate(const PlaneFit& fit) const;
  [[nodiscard]] std::vector<PlaneFit> guesses(const PlaneFit& rotation) const;
  [[nodiscard]] PlaneFit first_rotation(std::span<const Event> events) const;
  [[nodiscard]] PlaneFit maximized(std::span<const Event> events, const PlaneFit& guess);
  [[nodiscard]] double image_motion_px(const PlaneFit& fit) const;

  double max_window_s_;
  PinholeCamera camera_;
  const Gyroscope& gyroscope_;
  PlaneContrast contrast_;
};

}  // namespace saccade
