#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/tracking/event_contrast.h"

namespace saccade {

/// A log-intensity observation: between an event and any other of its run, which are all of one
/// pixel, the log intensity changed by exactly the difference of their relative log intensities l,
///   L(u, t_k) - L(u, t_j) = l_k - l_j = sum of p C over the events j + 1 .. k.
/// In runs of two neighbouring events that is p C.
struct EventRunObservation {
  double t_s = 0;
  Eigen::Vector2f pixel;              ///< undistorted
  Eigen::Vector3d ray;                ///< of the pixel, z = 1
  double relative_log_intensity = 0;  ///< [log units], up to an offset of the run
  std::uint32_t run = 0;
};

struct EventRunObservations {
  std::vector<EventRunObservation> observations;  ///< in order of time
  std::size_t runs = 0;                           ///< each of two observations or more
};

/// All events of some of the pixels, chosen by their position alone, about `max_events` > 0 at most,
/// in runs of up to `max_length` >= 2: long runs say more than many short ones, whose offsets
/// take much of it. `camera` with its lens.
[[nodiscard]] EventRunObservations observe_log_intensity(std::span<const Event> events,
                                                         const PinholeCamera& camera,
                                                         const EventContrast& contrast,
                                                         int max_events, int max_length);

}  // namespace saccade
