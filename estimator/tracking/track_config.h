#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/config/fields.h"
#include "core/config/method_table.h"
#include "estimator/run/camera_correction.h"
#include "estimator/tracking/edges/edge_tracker.h"
#include "estimator/tracking/intensity/intensity_tracker.h"
#include "estimator/tracking/polarity/polarity_tracker.h"
#include "estimator/tracking/reference_view.h"

namespace saccade {

/// The configuration of `saccade run track`; describe() names the keys, ranges and defaults.
struct TrackConfig {
  std::optional<std::filesystem::path> sensor;  ///< sensor.yaml, default of what follows
  std::string method = "edges";
  CameraCorrection camera;
  ReferenceOptions reference;
  MapOptions map;
  EdgeTrackerOptions edges;
  bool figures = false;  ///< of the method of edges
  MotionModelOptions motion = edges.motion;
  IntensityOptions intensity;
  PolarityOptions polarity;
  std::optional<double> contrast_on, contrast_off;  ///< [log units]; default: the dataset's
  /// tx ty tz qx qy qz qw, world from camera at the start; default: the ground truth.
  std::optional<std::array<double, 7>> initial_pose;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, TrackConfig& config);

/// What trackers are made from beside their options; it outlives them.
struct TrackWorld {
  PinholeCamera camera;   ///< with its lens
  MapPoints edge_points;  ///< in the frame of the first reference view
  IntensityMap intensity_map;
  std::optional<EventContrast> contrast;  ///< nullopt where nobody states it
  Gyroscope gyroscope;                    ///< empty unless it is needed
};

/// A method of tracking. A new one is a pair of files, its options in TrackConfig, and a row in
/// track_config.cpp, by which the module, the help and the tests know it.
struct TrackMethod {
  std::string_view name;  ///< value of `method`, and of the section that holds its options
  std::string_view help;
  void (*describe)(config::Fields&, TrackConfig&) = nullptr;
  std::unique_ptr<Tracker> (*make)(const TrackConfig&, const TrackWorld&);
  bool takes_frames = false;      ///< the dataset's grey frames in place of its events
  bool needs_prediction = false;  ///< motion.prediction: none is an error
  bool smooths_map = false;       ///< at its edges, by intensity.map_blur_px
  /// Abrupt at high speed, which carries a tracker through a shaken camera, and smooth at low speed;
  /// otherwise the motion model is that of edges.preset.
  bool has_speed_dependent_motion = true;
};

[[nodiscard]] std::span<const TrackMethod> track_methods();

/// The row of config.method.
[[nodiscard]] const TrackMethod& method_of(const TrackConfig& config);

}  // namespace saccade
