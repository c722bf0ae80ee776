#pragma once

#include <optional>
#include <string_view>

#include "core/io/dataset/dataset.h"

namespace saccade {

/// What a recording tells about the camera's path and the depth at best, from its truth alone: no
/// estimator has part in it. An edge of |grad L| = g that moves by d pixels across its line fires
/// where g min(d, 2) reaches the contrast threshold C, and then says to max(C / g / sqrt(12), 0.1)
/// pixels (sigma) where it is: anywhere on the way to its next event, and no better than blur and
/// noise leave to accurate methods. The bounds are those of Cramer and Rao for these observations,
/// for poses between which the view moves by two pixels, each within that motion of the one before.
/// Moving objects count as standing still.
struct Information {
  /// Changes with whatever changes a bound, so that stored ones are recognised as out of date.
  static constexpr int kVersion = 2;

  /// Position and rotation of a pose before a known map, RMS over the poses: the bound of tracking [%
  /// of the mean depth, deg].
  double pose_percent = 0;
  double pose_deg = 0;
  /// Position of the camera in a world that is not known, RMS over the poses: the bound of odometry,
  /// given the poses of the first 0.2 s, a tenth of the recording at most [% of the mean depth].
  double path_percent = 0;
  /// The same without them, up to a similarity transformation.
  double own_path_percent = 0;
  /// Share of the edge pixels whose depth is known to 5 % (sigma), given the poses.
  double depth_share = 0;

  /// Whether a method of a module ("track", "odometry", "depth", "reconstruct" ...) can succeed:
  /// a bound of the positions of at most half of what success allows (1 % of the depth), in tracking
  /// also of 2.5 degrees, or a depth for at least a twentieth of the edges. True for a module that no rule is about.
  [[nodiscard]] bool is_enough_for(std::string_view module, bool has_given_start = true) const;
};

/// nullopt where the dataset lacks poses, frames, or depth at the frames' times. Where no edge can
/// fire, nothing is known: 100 % and 180 degrees.
[[nodiscard]] std::optional<Information> information_of(const Dataset& dataset);

}  // namespace saccade
