#include <utility>

#include "estimator/tracking/frames/frame_tracker.h"
#include "estimator/tracking/track_config.h"

namespace saccade {
namespace {

void describe_edge_method(config::Fields& fields, TrackConfig& config) {
  describe_edges(fields, config.edges);
  if (!fields.has("preset")) return;
  config.motion = config.edges.motion;
  if (config.edges.preset != EdgeTrackerOptions::Preset::kThesis) return;
  config.map.max_fraction = 1;
  config.map.foreground_depth = false;
}

void describe_intensity_method(config::Fields& fields, TrackConfig& config) {
  describe(fields, config.intensity);
  fields
      .value("contrast", config.contrast,
             "Contrast threshold of both polarities in log units; ~ takes the dataset's. An error "
             "of a few percent costs accuracy, see the sweep tracking_contrast.")
      .above(0);
}

void describe_polarity_method(config::Fields& fields, TrackConfig& config) {
  describe(fields, config.polarity);
}

EdgeTracker edge_tracker(EdgeTrackerOptions options, const TrackConfig& config,
                         const TrackWorld& world) {
  options.motion = config.motion;
  EdgeTracker tracker(options, world.camera, world.edges, world.map.world_from_map(), config.seed);
  tracker.set_gyroscope(world.gyroscope);
  return tracker;
}

/// What the other methods fall back to: the accurate setting, whose template is drawn for every
/// frame, as only a few frames are followed from an uncertain pose.
EdgeTracker fallback_tracker(const TrackConfig& config, const TrackWorld& world) {
  EdgeTrackerOptions options;
  options.templates.redraw_px = 0;
  return edge_tracker(options, config, world);
}

std::unique_ptr<Tracker> make_edges(const TrackConfig& config, const TrackWorld& world) {
  return std::make_unique<EdgeTracker>(edge_tracker(config.edges, config, world));
}

std::unique_ptr<Tracker> make_intensity(const TrackConfig& config, const TrackWorld& world) {
  auto tracker =
      std::make_unique<IntensityTracker>(config.intensity, config.motion, world.contrast,
                                         world.camera, world.map, fallback_tracker(config, world));
  tracker->set_gyroscope(world.gyroscope);
  return tracker;
}

std::unique_ptr<Tracker> make_polarity(const TrackConfig& config, const TrackWorld& world) {
  auto tracker = std::make_unique<PolarityTracker>(config.polarity, config.motion, world.camera,
                                                   world.map, fallback_tracker(config, world));
  tracker->set_gyroscope(world.gyroscope);
  return tracker;
}

std::unique_ptr<Tracker> make_frames(const TrackConfig& config, const TrackWorld& world) {
  return std::make_unique<FrameTracker>(config.motion, world.map);
}

constexpr TrackMethod kTrackMethods[] = {
    {.name = "edges",
     .help = "Edges of the map against event frames (thesis chapter 4).",
     .describe = describe_edge_method,
     .make = make_edges},
    {.name = "intensity",
     .help = "Log intensity of the map against that of the pixels at their events.",
     .describe = describe_intensity_method,
     .make = make_intensity},
    {.name = "polarity",
     .help = "Brightness increments against the signs of the events.",
     .describe = describe_polarity_method,
     .make = make_polarity},
    {.name = "frames",
     .help = "Grey frames against the map: the baseline of a frame camera.",
     .describe = nullptr,
     .make = make_frames},
};

}  // namespace

std::span<const TrackMethod> track_methods() { return kTrackMethods; }

IntensityMapOptions smoothing_of(const TrackConfig& config) {
  IntensityMapOptions unsmoothed;
  unsmoothed.blur_px = 0;
  return config.method == "polarity" || config.method == "frames" ? unsmoothed
                                                                  : config.intensity.map;
}

}  // namespace saccade
