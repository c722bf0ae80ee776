#include "estimator/depth/rays/event_assignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/process/parallel.h"

namespace saccade {
namespace {

constexpr std::uint32_t kUnassigned = ~std::uint32_t{0};
/// Relative difference of depths up to which edgels share their events: that of neighbours on a
/// slanted surface.
constexpr float kSharedEventDepth = 0.02F;

bool is_same_depth(const FittedEdgel& a, const FittedEdgel& b) {
  const float difference = std::abs(a.edge.inverse_depth - b.edge.inverse_depth);
  return difference <= kSharedEventDepth * std::max(a.edge.inverse_depth, b.edge.inverse_depth) +
                           2 * (a.sigma + b.sigma);
}

}  // namespace

std::vector<FittedEdgel> assign_events(const std::vector<FittedEdgel>& edgels,
                                       const EdgelEvents& events, std::size_t event_count,
                                       double min_own_fraction) {
  std::vector<float> best(event_count, 0.F);
  std::vector<std::uint32_t> owner(event_count, kUnassigned);
  for (std::size_t k = 0; k < edgels.size(); ++k) {
    const float quality = edgels[k].support / edgels[k].residual_px;
    for (std::uint32_t i = edgels[k].first; i < edgels[k].last; ++i) {
      const float score = quality * events.weight[i];
      if (score <= best[events.event[i]]) continue;
      best[events.event[i]] = score;
      owner[events.event[i]] = static_cast<std::uint32_t>(k);
    }
  }
  std::vector<std::uint8_t> keeps(edgels.size());
  constexpr std::size_t kGrain = 256;
  const auto judge = [&](std::size_t k) {
    float own = 0, all = 0;
    for (std::uint32_t i = edgels[k].first; i < edgels[k].last; ++i) {
      const std::uint32_t other = owner[events.event[i]];
      all += events.weight[i];
      if (other == k || (other != kUnassigned && is_same_depth(edgels[k], edgels[other])))
        own += events.weight[i];
    }
    keeps[k] = own >= static_cast<float>(min_own_fraction) * all ? 1 : 0;
  };
  parallel_for(edgels.size(), judge, kGrain);
  std::vector<FittedEdgel> kept;
  for (std::size_t k = 0; k < edgels.size(); ++k)
    if (keeps[k] != 0) kept.push_back(edgels[k]);
  return kept;
}

}  // namespace saccade
