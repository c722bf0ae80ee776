#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "estimator/reconstruction/place_levels.h"
#include "estimator/reconstruction/reference_grid.h"

namespace saccade {

struct WeightedSort : LevelSort {
  float weight;  ///< 1 / deviation^2
};

/// All levels by track and, within one, in order of time. Tracks that begin near each other follow
/// each other, so that what they touch is at hand.
class LevelsByTrack {
 public:
  /// `view`: the pixels of the view that the levels are of, which outlive this.
  LevelsByTrack(const ReferenceGrid& view, std::span<const LevelSort> sorts);

  /// More levels, in order of time. Tracks are new in the order of their numbers.
  void add(std::span<const PlaceLevel> levels);

  /// After the last add(). Joins successive levels of one sort whose places lie within `thin_px` of
  /// the first of them: what they say of the image is nearly the same, and their mean says it.
  void order(float thin_px);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Calls body(levels) for every track.
  template <class Body>
  void for_each(const Body& body) const {
    for (const Tile& tile : tiles_)
      for (std::size_t t = 0; t < tile.tracks; ++t)
        body(std::span(tile.levels).subspan(tile.first[t], tile.first[t + 1] - tile.first[t]));
  }
  [[nodiscard]] const WeightedSort& sort(const PlaceLevel& level) const {
    return sorts_[level.sort()];
  }

 private:
  static constexpr int kTile = 16;  ///< [px]

  struct Tile {
    std::vector<PlaceLevel> levels;    ///< with the tile's own numbers of tracks
    std::vector<std::uint32_t> first;  ///< of every track, and the end
    std::uint32_t tracks = 0;
  };
  /// Where a track is.
  struct Home {
    std::uint32_t tile, track;
  };

  static void thin(std::span<const PlaceLevel> all, float px, Tile& tile);

  const ReferenceGrid& view_;
  std::vector<WeightedSort> sorts_;
  int tiles_per_row_;
  std::vector<Tile> tiles_;
  std::vector<Home> homes_;  ///< of every track
  std::size_t size_ = 0;
};

}  // namespace saccade
