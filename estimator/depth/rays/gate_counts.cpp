#include "estimator/depth/rays/gate_counts.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace saccade {

GateCounts& GateCounts::operator+=(const GateCounts& other) {
  still += other.still;
  weak += other.weak;
  scattered += other.scattered;
  uncertain += other.uncertain;
  alone += other.alone;
  foreign += other.foreign;
  hidden += other.hidden;
  jittered += other.jittered;
  return *this;
}

std::string main_gate(const GateCounts& dropped) {
  const std::array<std::pair<std::size_t, std::string_view>, 8> gates{{
      {dropped.still, "moved too little across their edge: the camera hardly translates"},
      {dropped.weak, "are seen by too few events"},
      {dropped.scattered, "do not move as the poses say"},
      {dropped.uncertain,
       "have a depth that is too uncertain (rays.max_sigma, rays.fusion.max_sigma)"},
      {dropped.alone, "disagree with their neighbours (rays.fusion)"},
      {dropped.foreign, "are explained by other edges"},
      {dropped.hidden, "were hidden at the time of the view, or lie outside of it"},
      {dropped.jittered, "have a depth that the noise of the poses makes too uncertain"},
  }};
  std::size_t all = 0;
  for (const auto& [count, reason] : gates) all += count;
  if (all == 0) return "no edge is seen by enough events";
  const auto most = std::max_element(
      gates.begin(), gates.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return fmt::format("{} of {} candidates {}", most->first, all, most->second);
}

}  // namespace saccade
