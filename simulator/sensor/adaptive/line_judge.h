#pragma once

#include <cstddef>
#include <optional>

#include "simulator/scene/scene.h"
#include "simulator/sensor/adaptive/view_sample.h"
#include "simulator/sensor/pixel/crossing.h"
#include "simulator/sensor/pixel/pixel_noise.h"

namespace saccade {

/// A pixel up to the time to which it has sensed.
struct SignalSoFar {
  ViewSample now;
  double before_s = 0;  ///< slope of the signal before that [1/s]
  bool has_slope = false;
};

/// What to do with the interval from there to a later sample.
struct LineJudgement {
  bool is_line = true;  ///< the line between both ends is good enough
  double t_s = 0;       ///< else where to sample next
  bool needs_ray = true;
};

/// Tells whether the log intensity between two samples of a pixel is a line, by what both see and by
/// its slope before: exact enough where it crosses a threshold, and far enough from one elsewhere.
class LineJudge {
 public:
  /// `scene` outlives it. `bracket_s`: as wide as a crossing is narrowed down, at most.
  LineJudge(const Scene& scene, double bracket_s, const PixelNoise& noise,
            std::size_t rays_per_pixel);

  /// `reset_s`: until when the pixel is blind. `step_s`: length of a step among edges.
  [[nodiscard]] LineJudgement judge(const SignalSoFar& pixel, const ViewSample& next,
                                    double reset_s, const Thresholds& thresholds,
                                    double step_s) const;
  /// Whether the signal of a pixel that sees one triangle stays within its band until `next`. The
  /// pixel is idle until then (PixelBank::is_idle).
  [[nodiscard]] static bool is_quiet(const SignalSoFar& pixel, const ViewSample& next,
                                     const Thresholds& thresholds);
  /// Whether two samples lie on one smooth surface; is_continuous(): under the same lights as well.
  [[nodiscard]] bool is_one_surface(const ViewSample& a, const ViewSample& b) const;
  [[nodiscard]] bool is_continuous(const ViewSample& a, const ViewSample& b) const;
  /// The first time between two samples at which the motion of what they see has a kink.
  [[nodiscard]] std::optional<double> first_kink_s(const ViewSample& from,
                                                   const ViewSample& to) const;

 private:
  const Scene& scene_;
  double bracket_s_;
  bool is_filtered_;
  double refractory_s_;
  double longest_line_s_;  ///< under flickering lights
  bool is_animated_;       ///< the corners of some triangles move in their body
  std::size_t rays_per_pixel_;
};

}  // namespace saccade
