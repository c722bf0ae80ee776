#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/event.h"
#include "estimator/depth/rays/event_assignment.h"
#include "estimator/depth/rays/event_rays.h"

namespace saccade {

/// By how much events come later than what they saw.
struct StreamDelay {
  double delay_s = 0;                                        ///< 0 where nothing tells
  double sigma_s = std::numeric_limits<double>::infinity();  ///< standard deviation

  /// With what is known beforehand: sensors, their drivers and clocks that were set by hand differ by about a
  /// millisecond. 0 where that is known better than this; a longer delay that is known well stays.
  [[nodiscard]] StreamDelay with_prior() const;
};

/// The delay on which edgels agree. An event that comes late by d lies where its edge is seen after d, so that
/// its residual is longer by n . x'(rho) d: a fifth unknown of the regression (ray_regression.h),
///   n . (a + b rho - e) = c + m s + h p + n . x'(rho) d,
/// which all edgels have in common, their own four marginalised. Where an edge moves uniformly, d is like c: such
/// edges tell nothing. `window_events`: those that `rays` are of.
[[nodiscard]] StreamDelay estimate_delay(const EventRays& rays,
                                         std::span<const Event> window_events,
                                         const std::vector<FittedEdgel>& edgels,
                                         const EdgelEvents& events);

}  // namespace saccade
