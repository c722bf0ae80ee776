#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/config/fields.h"
#include "core/config/method_table.h"
#include "estimator/run/camera_correction.h"
#include "estimator/tracking/edges/edge_tracker_config.h"
#include "estimator/tracking/intensity/intensity_tracker.h"
#include "estimator/tracking/polarity/polarity_tracker.h"
#include "estimator/tracking/reference_view.h"

namespace saccade {

/// The configuration of `saccade run track`; describe() names the keys, ranges and defaults.
struct TrackConfig {
  std::string method = "edges";
  CameraCorrection camera;
  ReferenceOptions reference;
  MapOptions map;
  EdgeTrackerOptions edges;
  MotionModelOptions motion = edges.motion;
  IntensityOptions intensity;
  PolarityOptions polarity;
  std::optional<double> contrast;  ///< [log units]; default: the dataset's
  /// tx ty tz qx qy qz qw, world from camera at the start; default: the ground truth.
  std::optional<std::array<double, 7>> initial_pose;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, TrackConfig& config);

/// A part of it, of other modules that track, too: which pixels become map points.
void describe(config::Fields& fields, MapOptions& options);

/// What trackers are made from beside their options; it outlives them.
struct TrackWorld {
  PinholeCamera camera;  ///< with its lens
  MapPoints edges;       ///< in the frame of the first reference view
  IntensityMap map;
  EventContrast contrast;  ///< of method: intensity
  Gyroscope gyroscope;     ///< empty unless it is needed
};

/// The methods of tracking. A new one is a pair of files, its options in TrackConfig, and a row in
/// track_methods.cpp.
using TrackMethod = config::MethodRow<TrackConfig, Tracker, const TrackWorld&>;
[[nodiscard]] std::span<const TrackMethod> track_methods();

/// How the method smooths the map's picture.
[[nodiscard]] IntensityMapOptions smoothing_of(const TrackConfig& config);

}  // namespace saccade
