#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/depth/ray_regression.h"

namespace saccade {

/// An edge after its regression, with the events that it explains.
struct FittedEdge {
  RayEdge edge;
  float sigma = 0;                    ///< of the inverse depth [1/m]
  float residual_px = 0;              ///< deviation of its events from it
  float support = 0;                  ///< sum of the weights of its events
  std::uint32_t first = 0, last = 0;  ///< its range in EdgeEvents
  float own = 1;                      ///< share of its events that no other edge explains better
  float unseen_px = 0;                ///< that it moved around the reference time without an event
};

struct OwnershipOptions {
  double min_share = 0.9;    ///< of an edge's weights that must be its own; 0 keeps every edge
  double same_depth = 0.02;  ///< edges whose depths differ by less, relatively, share their events
};

/// Every event comes from one place. Each is given to the edge that explains it best (its weight
/// there times the edge's support per residual); edges at the same depth, such as neighbours along
/// one contour, share. Dropped are edges that keep too little of what they rest on: they were
/// assembled from the events of others.
[[nodiscard]] std::vector<FittedEdge> with_own_events(const std::vector<FittedEdge>& edges,
                                                      const EdgeEvents& events,
                                                      std::size_t event_count,
                                                      const OwnershipOptions& options);

}  // namespace saccade
