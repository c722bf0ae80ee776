#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/depth/rays/event_rays.h"
#include "estimator/lanes.h"

namespace saccade {

/// An edgel: a short straight piece of an intensity edge in the reference view with its depth.
struct Edgel {
  Eigen::Vector2f pixel;    ///< on the edge
  Eigen::Vector2f normal;   ///< unit, towards the brighter side
  float inverse_depth = 0;  ///< [1/m]

  [[nodiscard]] Eigen::Vector2f tangent() const { return {-normal.y(), normal.x()}; }
};

/// Events whose rays pass near an edgel, in its coordinates at its inverse depth. Structure of arrays, of
/// size `padded()`; behind `count` the arrays hold zeros.
struct RayNeighbourhood {
  std::size_t count = 0;
  std::vector<std::uint32_t> event;  ///< index into the rays
  std::vector<float> across;         ///< n . (x(rho) - e) [px]
  std::vector<float> along;          ///< t . (x(rho) - e) [px]
  std::vector<float> parallax;       ///< n . b [px m]
  std::vector<float> polarity;       ///< +1, -1; 0 behind `count`

  /// Allocates room for `size` events and keeps those that it holds.
  void reserve(std::size_t size);
  /// Zeros up to padded().
  void pad();

  [[nodiscard]] std::size_t padded() const { return padded_to_lanes(count); }
};

/// Every `stride`-th time slice of [first, last).
struct SliceRange {
  int first = 0;
  int last = 0;
  int stride = 1;
};

/// The window around an edgel whose events are used.
struct GatherWindow {
  double radius_px = 1.5;       ///< across the edgel
  double half_length_px = 1.5;  ///< along it
};

/// Collects the events of an edgel: those whose rays pass within its window and whose polarity agrees
/// with its normal, p x'(rho) . n > 0. The edgel is projected into all slices at once, and the cells
/// of each slice that the window may have covered are read.
class RayGatherer {
 public:
  /// `rays` must outlive it.
  RayGatherer(const EventRays& rays, const GatherWindow& window);

  /// Not thread-safe: buffers are reused.
  void gather(const SliceRange& slices, const Edgel& edge, RayNeighbourhood& near);

  /// Motion of the last call's edgel along its normal on the sensor during each slice [px]; valid
  /// for the slices that were read.
  [[nodiscard]] const std::vector<float>& slice_motion_px() const { return slice_motion_px_; }

 private:
  static constexpr std::uint32_t kOn = std::uint32_t{1} << 31U;
  /// Contiguous events.
  struct Run {
    std::uint32_t begin, end;
    std::uint32_t polarity;  ///< kOn or 0
  };

  void add_run(std::uint32_t begin, std::uint32_t end, bool is_on);
  void load();
  void select(const Edgel& edge, RayNeighbourhood& near);

  const EventRays& rays_;
  float radius_px_, half_length_px_;
  /// Of every slice, padded to lanes: pixel_from_reference (9, by rows), centre_term (3) and the
  /// rates of both (12).
  std::vector<std::vector<float>> coefficients_;

  std::vector<float> slice_motion_px_;

  // Candidates: all events of the cells.
  std::vector<Run> runs_;
  std::size_t count_ = 0;
  std::vector<RayLine> line_;
  std::vector<std::uint32_t> event_;  ///< with its polarity in the highest bit
  std::vector<std::uint32_t> is_near_;
  std::vector<std::uint32_t> chosen_;
};

}  // namespace saccade
