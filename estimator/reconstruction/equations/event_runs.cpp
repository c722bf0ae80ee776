#include "estimator/reconstruction/equations/event_runs.h"

#include <numeric>

namespace saccade {
namespace {

constexpr int kRunTile_px = 16;

}  // namespace

EventRuns::EventRuns(const ReferenceGrid& grid, std::span<const ObservationKind> kinds)
    : grid_(grid),
      kinds_(kinds),
      tiles_per_row_(grid.width() / kRunTile_px + 1),
      tiles_(static_cast<std::size_t>(tiles_per_row_ * (grid.height() / kRunTile_px + 1))) {}

void EventRuns::add(std::span<const IntensityObservation> observations) {
  for (const IntensityObservation& o : observations) {
    if (o.run() == locations_.size()) {
      const auto tile =
          static_cast<std::uint32_t>(static_cast<int>(o.y) / kRunTile_px * tiles_per_row_ +
                                     static_cast<int>(grid_.wrapped_x(o.x)) / kRunTile_px);
      locations_.emplace_back(tile, tiles_[tile].runs++);
    }
    const auto [tile, run] = locations_[o.run()];
    tiles_[tile].observations.push_back(
        {o.x, o.y, o.log_intensity, IntensityObservation::tag(run, o.kind())});
  }
}

void EventRuns::sort_by_run(float merge_radius_px) {
  std::vector<IntensityObservation> ordered;
  std::vector<std::uint32_t> next;
  for (Tile& tile : tiles_) {
    tile.first.assign(tile.runs + 1, 0);
    for (const IntensityObservation& o : tile.observations) ++tile.first[o.run() + 1];
    std::partial_sum(tile.first.begin(), tile.first.end(), tile.first.begin());
    next.assign(tile.first.begin(), tile.first.end() - 1);
    ordered.resize(tile.observations.size());
    for (const IntensityObservation& o : tile.observations) ordered[next[o.run()]++] = o;
    merge(ordered, merge_radius_px, tile);
    size_ += tile.observations.size();
  }
  locations_ = {};
}

void EventRuns::merge(std::span<const IntensityObservation> all, float radius_px, Tile& tile) {
  std::size_t end = 0;
  for (std::size_t t = 0; t < tile.runs; ++t) {
    const std::size_t begin = tile.first[t], last = tile.first[t + 1];
    tile.first[t] = static_cast<std::uint32_t>(end);
    for (std::size_t k = begin; k < last;) {
      const IntensityObservation head = all[k];
      float x = 0, y = 0, log_intensity = 0;
      std::size_t n = 1;
      for (; k + n < last; ++n) {
        const IntensityObservation& next = all[k + n];
        const float dx = next.x - head.x, dy = next.y - head.y;
        if (next.kind() != head.kind() || !(dx * dx + dy * dy <= radius_px * radius_px) ||
            radius_px == 0)
          break;
        x += dx;
        y += dy;
        log_intensity += next.log_intensity - head.log_intensity;
      }
      const float per_count = 1 / static_cast<float>(n);
      tile.observations[end++] = {head.x + x * per_count, head.y + y * per_count,
                                  head.log_intensity + log_intensity * per_count,
                                  head.run_and_kind};
      k += n;
    }
  }
  tile.first.back() = static_cast<std::uint32_t>(end);
  tile.observations.resize(end);
}

}  // namespace saccade
