#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/depth/event_rays.h"
#include "estimator/lanes.h"

namespace saccade {

/// A short straight edge in the reference view with its depth.
struct RayEdge {
  Eigen::Vector2f pixel;    ///< on the edge
  Eigen::Vector2f normal;   ///< unit, towards the brighter side
  float inverse_depth = 0;  ///< [1/m]

  [[nodiscard]] Eigen::Vector2f tangent() const { return {-normal.y(), normal.x()}; }
};

/// Events that pass near an edge, in its coordinates at its inverse depth. Structure of arrays, of
/// size `padded()`; behind `count` the arrays hold zeros.
struct RayNeighbourhood {
  std::size_t count = 0;
  std::vector<std::uint32_t> event;  ///< index into the rays
  std::vector<float> across;         ///< n . (x(rho) - e) [px]
  std::vector<float> along;          ///< t . (x(rho) - e) [px]
  std::vector<float> parallax;       ///< n . b [px m]
  std::vector<float> polarity;       ///< +1, -1; 0 behind `count`

  /// Room for `size` events, those that are there are kept.
  void reserve(std::size_t size);
  /// Zeros up to padded().
  void pad();

  [[nodiscard]] std::size_t padded() const { return padded_to_lanes(count); }
};

/// Every `stride`-th slab of [first, last).
struct SlabSteps {
  int first = 0;
  int last = 0;
  int stride = 1;
};

/// The strip around an edge whose events count.
struct GatherReach {
  double radius_px = 1.5;       ///< across the edge
  double half_length_px = 1.5;  ///< along it
};

/// Collects the events of an edge: those whose rays pass within the reach of it, and whose polarity
/// fits its normal, p x'(rho) . n > 0. The edge is projected into every slab (all slabs at once),
/// where the cells that it may have passed over during the slab are read.
class RayGatherer {
 public:
  /// `rays` must outlive it.
  RayGatherer(const EventRays& rays, const GatherReach& reach);

  /// Not thread-safe: the arrays on the way are kept.
  void gather(const SlabSteps& slabs, const RayEdge& edge, RayNeighbourhood& near);

  /// How far the edge of the last call moved across itself on the sensor during each slab [px]; of
  /// the slabs that were looked at.
  [[nodiscard]] const std::vector<float>& crossing_px() const { return crossing_px_; }

 private:
  static constexpr std::uint32_t kOn = std::uint32_t{1} << 31U;
  /// Events that lie together.
  struct Run {
    std::uint32_t begin, end;
    std::uint32_t polarity;  ///< kOn or 0
  };

  void add_run(std::uint32_t begin, std::uint32_t end, bool is_on);
  void load();
  void select(const RayEdge& edge, RayNeighbourhood& near);

  const EventRays& rays_;
  float radius_px_, half_length_px_;
  /// Of every slab, padded to lanes: pixel_from_reference (9, by rows), centre_term (3) and the
  /// rates of both (12).
  std::vector<std::vector<float>> coefficients_;

  std::vector<float> crossing_px_;

  // Candidates: all events of the cells.
  std::vector<Run> runs_;
  std::size_t count_ = 0;
  std::vector<RayLine> line_;
  std::vector<std::uint32_t> event_;  ///< with its polarity in the highest bit
  std::vector<std::uint32_t> is_near_;
  std::vector<std::uint32_t> chosen_;
};

}  // namespace saccade
