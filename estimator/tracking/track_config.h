#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/config/fields.h"
#include "estimator/run/camera_correction.h"
#include "estimator/tracking/frame_tracker.h"
#include "estimator/tracking/intensity_tracker.h"
#include "estimator/tracking/polarity_tracker.h"
#include "estimator/tracking/reference_view.h"
#include "estimator/tracking/tracker.h"
#include "estimator/tracking/tracker_config.h"

namespace saccade {

/// The configuration of `saccade run track`; describe() names the keys, ranges and defaults.
struct TrackConfig {
  enum class Method { kEdges, kIntensity, kPolarity, kFrames };

  Method method = Method::kEdges;
  CameraCorrection camera;
  ReferenceOptions reference;
  MapOptions map;
  TrackerOptions tracker;
  IntensityOptions intensity;
  PolarityOptions polarity;
  FrameTrackOptions frames;
  IntensityMapOptions frames_map{.blur_px = 0};
  std::optional<double> contrast;  ///< [log units]; default: the dataset's
  /// tx ty tz qx qy qz qw, world from camera at the start; default: the ground truth.
  std::optional<std::array<double, 7>> initial_pose;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, TrackConfig& config);

/// A part of it, of other modules that track, too: which pixels become map points.
void describe(config::Fields& fields, MapOptions& options);

}  // namespace saccade
