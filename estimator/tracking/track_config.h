#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/config/fields.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// Where the map comes from.
struct ReferenceOptions {
  std::optional<int> frame;  ///< index in images.txt; default: the first at or after the start
  std::optional<double>
      planar_depth_m;  ///< the map is a plane at this z of the reference view; else the depth map
  /// Left, top, right, bottom [px] of the part of the undistorted frame that becomes the map; a
  /// plane rarely fills the view. Default: all of it.
  std::optional<std::array<double, 4>> region_px;
  double time_offset_s = 0;  ///< the frame shows the scene this long after its stamp
};

/// The configuration of `saccade run track`; describe() names the keys, ranges and defaults.
struct TrackConfig {
  ReferenceOptions reference;
  MapOptions map;
  TrackerOptions tracker;
  /// tx ty tz qx qy qz qw, world from camera at the start; default: the ground truth.
  std::optional<std::array<double, 7>> initial_pose;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, TrackConfig& config);

}  // namespace saccade
