#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/tracking/event_contrast.h"

namespace saccade {

/// Brightness-increment images: by how much the log intensity of each pixel changed within windows
/// of equally many events, sum of p C over the window, to within a threshold. Pixels without events
/// belong to them: they changed by less than one.
struct IncrementImages {
  struct Pixel {
    Eigen::Vector2f pixel;  ///< undistorted
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

/// Of windows of `window_events` > 0 events, and of some of the pixels, chosen by their position
/// alone, so that there are about `increments` > 0 at most. `camera` with its lens. No window where
/// there are no events.
[[nodiscard]] IncrementImages observe_increments(std::span<const Event> events,
                                                 const PinholeCamera& camera,
                                                 const EventContrast& contrast, int window_events,
                                                 int increments);

}  // namespace saccade
