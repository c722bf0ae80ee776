#include "estimator/depth/event_ownership.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr std::uint32_t kNobody = ~std::uint32_t{0};

bool is_same_depth(const FittedEdge& a, const FittedEdge& b, float tolerance) {
  const float difference = std::abs(a.edge.inverse_depth - b.edge.inverse_depth);
  return difference <=
         tolerance * std::max(a.edge.inverse_depth, b.edge.inverse_depth) + 2 * (a.sigma + b.sigma);
}

}  // namespace

std::vector<FittedEdge> with_own_events(const std::vector<FittedEdge>& edges,
                                        const EdgeEvents& events, std::size_t event_count,
                                        const OwnershipOptions& options) {
  std::vector<float> best(event_count, 0.F);
  std::vector<std::uint32_t> owner(event_count, kNobody);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const float quality = edges[k].support / edges[k].residual_px;
    for (std::uint32_t i = edges[k].first; i < edges[k].last; ++i) {
      const float score = quality * events.weight[i];
      if (score <= best[events.event[i]]) continue;
      best[events.event[i]] = score;
      owner[events.event[i]] = static_cast<std::uint32_t>(k);
    }
  }
  std::vector<FittedEdge> kept;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    float own = 0, all = 0;
    for (std::uint32_t i = edges[k].first; i < edges[k].last; ++i) {
      const std::uint32_t other = owner[events.event[i]];
      all += events.weight[i];
      if (other == k || (other != kNobody && is_same_depth(edges[k], edges[other],
                                                           static_cast<float>(options.same_depth))))
        own += events.weight[i];
    }
    if (!(own >= static_cast<float>(options.min_share) * all)) continue;
    kept.push_back(edges[k]);
    kept.back().own = own / all;
  }
  return kept;
}

}  // namespace saccade
