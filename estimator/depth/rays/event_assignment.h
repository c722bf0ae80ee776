#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/depth/rays/ray_regression.h"

namespace saccade {

/// An edgel after its regression, with the events that it explains.
struct FittedEdgel {
  Edgel edge;
  float sigma = 0;                    ///< of the inverse depth [1/m]
  float residual_px = 0;              ///< standard deviation of its events from it
  float support = 0;                  ///< sum of the weights of its events
  std::uint32_t first = 0, last = 0;  ///< its range in EdgelEvents
  float unobserved_px = 0;  ///< motion around the reference time during which it had no event
};

/// Assigns every event to the edgel that explains it best (its weight there times the edgel's
/// support per residual), since every event has one cause; edgels at the same depth, such as
/// neighbours along one contour, share events. Edgels that keep less than `min_own_fraction` of the
/// weight of their events are dropped: they were assembled from the events of others. 0 keeps all.
[[nodiscard]] std::vector<FittedEdgel> assign_events(const std::vector<FittedEdgel>& edgels,
                                                     const EdgelEvents& events,
                                                     std::size_t event_count,
                                                     double min_own_fraction);

}  // namespace saccade
