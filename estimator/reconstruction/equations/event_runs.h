#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "estimator/reconstruction/observations/intensity_observations.h"
#include "estimator/reconstruction/observations/reference_grid.h"

namespace saccade {

/// All observations by event run and, within one, in order of time. Runs that begin near each other
/// are stored near each other, so that the unknowns they touch stay in the cache.
class EventRuns {
 public:
  /// `grid`: the pixels that the observations are of. Both outlive this; kinds are
  /// complete before the first observation.
  EventRuns(const ReferenceGrid& grid, std::span<const ObservationKind> kinds);

  /// More observations, in order of time. Runs begin in the order of their numbers.
  void add(std::span<const IntensityObservation> observations);

  /// After the last add(). Merges successive observations of one kind whose reprojections lie within
  /// `merge_radius_px` of the first of them into their mean: they observe nearly the same, with
  /// errors of the same origin.
  void sort_by_run(float merge_radius_px);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Calls body(observations) for every run.
  template <class Body>
  void for_each(const Body& body) const {
    for (const Tile& tile : tiles_)
      for (std::size_t t = 0; t < tile.runs; ++t)
        body(
            std::span(tile.observations).subspan(tile.first[t], tile.first[t + 1] - tile.first[t]));
  }
  [[nodiscard]] const ObservationKind& kind(const IntensityObservation& observation) const {
    return kinds_[observation.kind()];
  }

 private:
  struct Tile {
    std::vector<IntensityObservation> observations;  ///< with the tile's own numbers of runs
    std::vector<std::uint32_t> first;                ///< of every run, and the end
    std::uint32_t runs = 0;
  };
  static void merge(std::span<const IntensityObservation> all, float radius_px, Tile& tile);

  const ReferenceGrid& grid_;
  std::span<const ObservationKind> kinds_;
  int tiles_per_row_;
  std::vector<Tile> tiles_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      locations_;  ///< tile and number in it, of every run
  std::size_t size_ = 0;
};

}  // namespace saccade
