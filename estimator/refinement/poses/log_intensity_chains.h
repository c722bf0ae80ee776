#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/tracking/intensity/intensity_options.h"

namespace saccade {

/// A log-intensity observation: between an event and any other of its chain, which are all of one
/// pixel, the log intensity changed by exactly the difference of their levels,
///   L(u, t_k) - L(u, t_j) = level_k - level_j = sum of p C over the events j + 1 .. k.
/// In chains of two neighbouring events that is p C.
struct ChainObservation {
  double t_s = 0;
  Eigen::Vector2f pixel;  ///< undistorted
  Eigen::Vector3d ray;    ///< of the pixel, z = 1
  double level = 0;       ///< [log units], up to an offset of the chain
  std::uint32_t chain = 0;
};

struct LogIntensityChains {
  std::vector<ChainObservation> observations;  ///< in order of time
  std::size_t chains = 0;                      ///< each of two observations or more
};

/// All events of some of the pixels, chosen by their position alone, about `max_events` > 0 at most,
/// in chains of up to `max_length` >= 2: long chains say more than many short ones, whose offsets
/// take much of it. `camera` with its lens.
[[nodiscard]] LogIntensityChains observe_log_intensity(std::span<const Event> events,
                                                       const PinholeCamera& camera,
                                                       const EventContrast& contrast,
                                                       int max_events, int max_length);

}  // namespace saccade
