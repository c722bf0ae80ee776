#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/tracking/intensity/intensity_options.h"

namespace saccade {

struct IncrementOptions {
  int window_events = 5000;  ///< in a window
  int increments = 1000000;  ///< about so many at most, of evenly spread pixels
  /// Deviations beyond which one counts less (Cauchy). The rounding to whole thresholds is no
  /// outlier; where it counts as one, the many increments of 0 slow the path down.
  double outlier = 3;
};

/// Brightness-increment images: by how much the log intensity of each pixel changed within windows
/// of equally many events, sum of p C over the window, to within a threshold. Pixels without events
/// belong to them: they changed by less than one.
struct IncrementImages {
  struct Pixel {
    Eigen::Vector2f place;  ///< undistorted
    Eigen::Vector3d ray;    ///< z = 1
  };
  std::vector<Pixel> pixels;
  std::vector<double> times_s;    ///< window i from times_s[i] to times_s[i + 1]; none or two
  std::vector<float> increments;  ///< [log units], window by window, as `pixels`

  [[nodiscard]] std::size_t windows() const { return times_s.empty() ? 0 : times_s.size() - 1; }
  [[nodiscard]] double increment(std::size_t window, std::size_t pixel) const {
    return static_cast<double>(increments[window * pixels.size() + pixel]);
  }
};

/// Of some of the pixels, chosen by their place alone. `camera` with its lens. No window where
/// there are no events.
[[nodiscard]] IncrementImages observe_increments(std::span<const Event> events,
                                                 const PinholeCamera& camera,
                                                 const EventContrast& contrast,
                                                 const IncrementOptions& options);

}  // namespace saccade
