#include "estimator/reconstruction/levels_by_track.h"

#include <numeric>

namespace saccade {

LevelsByTrack::LevelsByTrack(const ReferenceGrid& view, std::span<const LevelSort> sorts)
    : view_(view),
      tiles_per_row_(view.width() / kTile + 1),
      tiles_(static_cast<std::size_t>(tiles_per_row_ * (view.height() / kTile + 1))) {
  for (const LevelSort& sort : sorts)
    sorts_.push_back({sort, 1 / (sort.deviation * sort.deviation)});
}

void LevelsByTrack::add(std::span<const PlaceLevel> levels) {
  for (const PlaceLevel& l : levels) {
    if (l.track() == homes_.size()) {
      const auto tile =
          static_cast<std::uint32_t>(static_cast<int>(l.y) / kTile * tiles_per_row_ +
                                     static_cast<int>(view_.in_first_turn(l.x)) / kTile);
      homes_.push_back({tile, tiles_[tile].tracks++});
    }
    const Home home = homes_[l.track()];
    tiles_[home.tile].levels.push_back({l.x, l.y, l.level, PlaceLevel::tag(home.track, l.sort())});
  }
}

void LevelsByTrack::order(float thin_px) {
  std::vector<PlaceLevel> ordered;
  std::vector<std::uint32_t> next;
  for (Tile& tile : tiles_) {
    tile.first.assign(tile.tracks + 1, 0);
    for (const PlaceLevel& level : tile.levels) ++tile.first[level.track() + 1];
    std::partial_sum(tile.first.begin(), tile.first.end(), tile.first.begin());
    next.assign(tile.first.begin(), tile.first.end() - 1);
    ordered.resize(tile.levels.size());
    for (const PlaceLevel& level : tile.levels) ordered[next[level.track()]++] = level;
    thin(ordered, thin_px, tile);
    size_ += tile.levels.size();
  }
  homes_ = {};
}

void LevelsByTrack::thin(std::span<const PlaceLevel> all, float px, Tile& tile) {
  std::size_t end = 0;
  for (std::size_t t = 0; t < tile.tracks; ++t) {
    const std::size_t begin = tile.first[t], last = tile.first[t + 1];
    tile.first[t] = static_cast<std::uint32_t>(end);
    for (std::size_t k = begin; k < last;) {
      const PlaceLevel head = all[k];
      float x = 0, y = 0, level = 0;
      std::size_t n = 1;
      for (; k + n < last; ++n) {
        const PlaceLevel& next = all[k + n];
        const float dx = next.x - head.x, dy = next.y - head.y;
        if (next.sort() != head.sort() || !(dx * dx + dy * dy <= px * px) || px == 0) break;
        x += dx;
        y += dy;
        level += next.level - head.level;
      }
      const float share = 1 / static_cast<float>(n);
      tile.levels[end++] = {head.x + x * share, head.y + y * share, head.level + level * share,
                            head.track_and_sort};
      k += n;
    }
  }
  tile.first.back() = static_cast<std::uint32_t>(end);
  tile.levels.resize(end);
}

}  // namespace saccade
