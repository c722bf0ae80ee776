#include "estimator/tracking/track_config.h"

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

/// The motion model of the methods that do not use event frames: abrupt at high speed, which
/// carries them through a shaken camera, and smooth at low speed.
MotionModelOptions speed_dependent_motion() {
  return {.prediction = MotionModelOptions::Prediction::kConstantVelocity,
          .acceleration_sigma_px = 300,
          .acceleration_per_speed = 6};
}

}  // namespace

void describe(config::Fields& fields, MapOptions& options) {
  fields
      .value("min_gradient", options.min_gradient,
             "g_min: gradient magnitude of a map point, relative to the largest one. A "
             "larger one keeps fewer, stronger edges.")
      .range(0, 1);
  fields
      .value(
          "max_fraction", options.max_fraction,
          "Largest fraction of the pixels that become map points, the steepest ones; 1 keeps all. "
          "A map that fills the view leaves no contrast between edge and surface.")
      .above(0)
      .at_most(1);
}

void describe(config::Fields& fields, TrackConfig& config) {
  using config::Fields;
  config::describe_method(fields, "method", config.method, track_methods(), config,
                          "Method of tracking: edges against event frames (the thesis), the log "
                          "intensity at each event, brightness increments against the signs of the "
                          "events, or grey frames.");
  if (fields.has("method") && config.method != "edges") config.motion = speed_dependent_motion();
  fields.section("motion", config.motion, "Motion model that predicts the next pose.");
  fields.expect(config.method != "polarity" ||
                    config.motion.prediction != MotionModelOptions::Prediction::kNone,
                "method", "polarity needs a motion.prediction");
  fields.section("camera", config.camera, "Corrections of the camera's calibration.");
  fields.group(
      "reference", [&](Fields& f) { describe_reference(f, config.reference); },
      "Reference views that the map is made from.");
  fields.section("map", config.map,
                 "Pixels of a reference view that become map points (section 4.4 of the thesis).");
  fields.value("initial_pose", config.initial_pose,
               "Pose at the start, world from camera, as tx ty tz qx qy qz qw; ~ takes the ground "
               "truth.");
  fields.value("seed", config.seed, "Seed of the random samples.");
}

}  // namespace saccade
