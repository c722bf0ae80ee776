#include "estimator/tracking/track_config.h"

#include "estimator/run/sensor_input.h"
#include "estimator/tracking/frames/frame_tracker.h"

namespace saccade {
namespace {

void describe_reference(config::Fields& fields, ReferenceOptions& options) {
  fields
      .value("frame", options.frame,
             "Index of the reference frame in images.txt; ~ takes the first at or after the start.")
      .at_least(0);
  fields
      .value("planar_depth_m", options.planar_depth_m,
             "Depth in metres of a plane parallel to the reference view that is the map; ~ reads "
             "the depth map. A wrong depth scales the translation.")
      .above(0);
  fields
      .value(
          "region_px", options.region_px,
          "Left, top, right and bottom pixel of the part of the reference frame that becomes the "
          "map; ~ takes all of it.")
      .at_least(0);
  fields
      .value(
          "new_view_deg", options.new_view_deg,
          "Rotation in degrees from all views of the map at which a further frame joins it; ~ "
          "keeps one view. A smaller one covers more and costs memory; it needs the ground truth.")
      .range(1, 180);
  fields
      .value(
          "time_offset_s", options.time_offset_s,
          "True time of the reference frame minus its time stamp, in seconds, as of the exposure "
          "or the readout.")
      .range(-1, 1);
}

/// See TrackMethod::has_speed_dependent_motion.
MotionModelOptions speed_dependent_motion() {
  return {.prediction = MotionModelOptions::Prediction::kConstantVelocity,
          .acceleration_sigma_px = 300,
          .acceleration_per_speed = 6};
}

void describe_edge_method(config::Fields& fields, TrackConfig& config) {
  describe(fields, config.edges);
  fields.value(
      "figures", config.figures,
      "Whether to write the data of the thesis's figures 4.1, 4.2 and 4.4 to 4.6, of a pose "
      "in the middle of the run, to figures/.");
  if (!fields.has("preset")) return;
  config.motion = config.edges.motion;
  if (config.edges.preset != EdgeTrackerOptions::Preset::kThesis) return;
  config.map.max_fraction = 1;
  config.map.foreground_depth = false;
}

void describe_intensity_method(config::Fields& fields, TrackConfig& config) {
  describe(fields, config.intensity);
  fields
      .value(
          "contrast_on", config.contrast_on,
          "Contrast threshold of ON events in log units; ~ takes the dataset's, or where it states "
          "none, one that is found from the first events and the edges of the map. An error of a "
          "few percent costs accuracy, see the sweep tracking_contrast.")
      .above(0);
  fields
      .value("contrast_off", config.contrast_off,
             "Contrast threshold of OFF events in log units; ~ as with contrast_on.")
      .above(0);
}

void describe_polarity_method(config::Fields& fields, TrackConfig& config) {
  describe(fields, config.polarity);
}

EdgeTracker edge_tracker(EdgeTrackerOptions options, const TrackConfig& config,
                         const TrackWorld& world) {
  options.motion = config.motion;
  EdgeTracker tracker(options, world.camera, world.edge_points,
                      world.intensity_map.world_from_map(), config.seed);
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
  auto tracker = std::make_unique<IntensityTracker>(config.intensity, config.motion, world.contrast,
                                                    world.camera, world.intensity_map,
                                                    fallback_tracker(config, world));
  tracker->set_gyroscope(world.gyroscope);
  return tracker;
}

std::unique_ptr<Tracker> make_polarity(const TrackConfig& config, const TrackWorld& world) {
  auto tracker =
      std::make_unique<PolarityTracker>(config.polarity, config.motion, world.camera,
                                        world.intensity_map, fallback_tracker(config, world));
  tracker->set_gyroscope(world.gyroscope);
  return tracker;
}

std::unique_ptr<Tracker> make_frames(const TrackConfig& config, const TrackWorld& world) {
  return std::make_unique<FrameTracker>(config.motion, world.intensity_map);
}

constexpr TrackMethod kTrackMethods[] = {
    {.name = "edges",
     .help = "Edges of the map against event frames (thesis chapter 4).",
     .describe = describe_edge_method,
     .make = make_edges,
     .has_speed_dependent_motion = false},
    {.name = "intensity",
     .help = "Log intensity of the map against that of the pixels at their events.",
     .describe = describe_intensity_method,
     .make = make_intensity,
     .smooths_map = true},
    {.name = "polarity",
     .help = "Brightness increments against the signs of the events.",
     .describe = describe_polarity_method,
     .make = make_polarity,
     .needs_prediction = true},
    {.name = "frames",
     .help = "Grey frames against the map: the baseline of a frame camera.",
     .make = make_frames,
     .takes_frames = true},
};

}  // namespace

std::span<const TrackMethod> track_methods() { return kTrackMethods; }

const TrackMethod& method_of(const TrackConfig& config) {
  return config::find_method(track_methods(), config.method);
}

void describe(config::Fields& fields, TrackConfig& config) {
  using config::Fields;
  if (const auto sensor = describe_sensor(fields, config.sensor)) {
    config.contrast_on = sensor->estimator_contrast_on();
    config.contrast_off = sensor->estimator_contrast_off();
    if (sensor->events.mismatch_sigma)
      config.intensity.mismatch_sigma = sensor->events.mismatch_sigma;
  }
  config::describe_method(fields, "method", config.method, track_methods(), config,
                          "What is compared with the map.");
  const TrackMethod& method = method_of(config);
  if (fields.has("method") && method.has_speed_dependent_motion)
    config.motion = speed_dependent_motion();
  fields.section("motion", config.motion, "Motion model that predicts the next pose.");
  fields.expect(
      !method.needs_prediction || config.motion.prediction != MotionModelOptions::Prediction::kNone,
      "method", std::string(method.name) + " needs a motion.prediction");
  fields.section("camera", config.camera, "Corrections of the camera's calibration.");
  fields.group(
      "reference", [&](Fields& f) { describe_reference(f, config.reference); },
      "Reference views that the map is made from.");
  fields.value("initial_pose", config.initial_pose,
               "Pose at the start, world from camera, as tx ty tz qx qy qz qw; ~ takes the ground "
               "truth.");
  fields.value("seed", config.seed, "Seed of the random samples.");
}

}  // namespace saccade
