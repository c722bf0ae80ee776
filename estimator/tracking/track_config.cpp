#include "estimator/tracking/track_config.h"

namespace saccade {
namespace {

void describe_reference(config::Fields& fields, ReferenceOptions& options) {
  fields
      .value("frame", options.frame,
             "index of the reference frame; ~ is the first at or after the start")
      .at_least(0);
  fields
      .value("planar_depth_m", options.planar_depth_m,
             "the map is a plane at this depth of the reference view; ~ takes the depth map")
      .above(0);
  fields.value("region_px", options.region_px,
               "left, top, right, bottom of the part of the frame that becomes the map; ~ is all");
  fields
      .value(
          "turn_deg", options.turn_deg,
          "a further frame joins the map where the view has turned so far from all others; ~: one "
          "frame")
      .range(1, 180);
  fields
      .value("time_offset_s", options.time_offset_s,
             "the frame shows the scene this long after its time stamp (exposure, readout)")
      .range(-1, 1);
}

void describe_map_image(config::Fields& fields, IntensityMapOptions& options) {
  fields
      .value("edge_step", options.edge_step,
             "the map is smoothed where neighbours differ by more [log units]")
      .range(0.001, 100);
  fields.value("blur_px", options.blur_px, "deviation of that Gaussian; 0: nothing is smoothed")
      .range(0, 10);
}

void describe_level_noise(config::Fields& fields, double& noise, double& place_px) {
  fields.value("noise", noise, "deviation of a level from the map [log units]").range(0.001, 10);
  fields
      .value("place_px", place_px,
             "deviation of the place where the map shows a level: it is sampled at points")
      .range(0, 10);
}

void describe_information(config::Fields& fields, double& information) {
  fields
      .value("information", information,
             "share of the information of independent residuals: neighbouring ones err alike")
      .range(1e-6, 1);
}

void describe_intensity(config::Fields& fields, TrackConfig& config) {
  IntensityOptions& options = config.intensity;
  fields
      .value("events", options.events,
             "per pose; ~: 1000, times (width / 240 px)^1.5 on a wider sensor")
      .range(1, 1e6);
  fields
      .value("samples", options.samples,
             "at most so many of a pose's events are aligned, evenly spread; the others only count")
      .range(10, 1e6);
  fields
      .value("pixels_per_event", options.pixels_per_event,
             "pixels between their events that are aligned, too, for each event that is")
      .range(0, 1000);
  fields
      .value("least_slope", options.least_slope,
             "of the map where such a pixel looks [log units/px]")
      .range(0, 100);
  fields.value("half_step", options.half_step,
               "such a pixel is taken to have gone on by half a threshold since its last event");
  fields.value("iterations", options.iterations, "of Gauss-Newton, always all of them")
      .range(1, 1000);
  describe_level_noise(fields, options.noise, options.place_px);
  fields
      .value("correction", options.correction,
             "least share by which a pixel's level is drawn to the map at each of its events")
      .range(0, 1);
  describe_map_image(fields, options.map);
  fields
      .value("redraw_deg", options.redraw_deg,
             "the map is drawn anew when the view has moved this far")
      .range(0.05, 20);
  fields
      .value("inlier_drop", options.inlier_drop,
             "lost below this share of the inlier ratio that is usual")
      .range(0, 1);
  fields
      .value("silence_px", options.silence_px,
             "lost where the camera should have moved so far without an event")
      .range(0.1, 1e6);
  describe_information(fields, options.information);
  fields
      .value("contrast", config.contrast,
             "threshold of both polarities [log units]; ~ takes the dataset's")
      .above(0);
}

void describe_polarity(config::Fields& fields, PolarityOptions& options) {
  fields.value("events", options.events, "per pose").range(1, 1e6);
  fields.value("iterations", options.iterations, "of Gauss-Newton, always all of them")
      .range(1, 1000);
  fields.value("reversals", options.reversals,
               "an event that turns its pixel's polarity round counts twice: two thresholds were "
               "crossed");
  fields
      .value("min_slope", options.min_slope,
             "slope of the increments that are compared, as a share of the RMS of all")
      .range(0, 100);
  fields
      .value("noise", options.noise,
             "deviation of a pixel's sum of polarities from what is expected [thresholds]")
      .range(0.001, 10);
  fields
      .value("place_px", options.place_px,
             "deviation of the place where the map shows an increment: it is sampled at points")
      .range(0, 10);
  fields
      .value("redraw_px", options.redraw_px,
             "the map is drawn anew when the view has moved this far")
      .range(0.1, 100);
  describe_information(fields, options.information);
  fields
      .value(
          "min_agreement", options.min_agreement,
          "share of the increments that have the expected sign, below which the edges take over; "
          "0.5 is chance")
      .range(0, 1);
}

void describe_frames(config::Fields& fields, TrackConfig& config) {
  FrameTrackOptions& options = config.frames;
  fields
      .value("samples", options.samples,
             "most pixels of a frame that are compared, spread evenly over it")
      .range(16, 1e9);
  fields
      .value("levels", options.levels,
             "of squares, from 2^(levels - 1) pixels wide down to single ones")
      .range(1, 8);
  fields.value("iterations", options.iterations, "of Gauss-Newton, on each level").range(1, 1000);
  describe_level_noise(fields, options.noise, options.place_px);
  describe_map_image(fields, config.frames_map);
  describe_information(fields, options.information);
  fields
      .value("min_inliers", options.min_inliers,
             "share of pixels that agree with the map below which the pose is lost")
      .range(0, 1);
}

}  // namespace

void describe(config::Fields& fields, MapOptions& options) {
  fields
      .value("min_gradient", options.min_gradient,
             "g_min: gradient magnitude of a map point, share of the largest")
      .range(0, 1);
  fields.value("max_share", options.max_share, "largest share of the pixels: the steepest of them")
      .above(0)
      .at_most(1);
  fields.value("thin", options.thin, "keep only the maxima across an edge");
  fields.value("foreground_depth", options.foreground_depth,
               "an edge between two depths belongs to the nearer one");
}

void describe(config::Fields& fields, TrackConfig& config) {
  using config::Fields;
  TrackerOptions& tracker = config.tracker;
  fields.choice(
      "method", config.method,
      {{"edges", TrackConfig::Method::kEdges},
       {"intensity", TrackConfig::Method::kIntensity},
       {"polarity", TrackConfig::Method::kPolarity},
       {"frames", TrackConfig::Method::kFrames}},
      "edges against event frames (the thesis), log intensity at each event, brightness increments "
      "against signed event frames, or grey frames");
  fields.section("camera", config.camera, "what is taken to differ from the calibration");
  fields.group(
      "reference", [&](Fields& f) { describe_reference(f, config.reference); },
      "where the map comes from");
  fields.group(
      "map", [&](Fields& f) { describe(f, config.map); },
      "which pixels of the reference frame become map points (4.4)");
  describe_edges(fields, tracker);
  if (config.method == TrackConfig::Method::kIntensity)
    fields.group(
        "intensity", [&](Fields& f) { describe_intensity(f, config); },
        "how a pose is found from the log intensity at each event");
  if (config.method == TrackConfig::Method::kPolarity)
    fields.group(
        "polarity", [&](Fields& f) { describe_polarity(f, config.polarity); },
        "how a pose is found from the signs of the events");
  if (config.method == TrackConfig::Method::kFrames)
    fields.group(
        "frames", [&](Fields& f) { describe_frames(f, config); },
        "how a pose is found from a grey frame");
  describe_expectation(fields, tracker);
  fields.expect(config.method != TrackConfig::Method::kPolarity ||
                    tracker.motion.prediction != PredictionOptions::Prediction::kNone,
                "method", "polarity needs a motion.prediction");
  fields.value("initial_pose", config.initial_pose,
               "tx ty tz qx qy qz qw at the start; ~ is the ground truth");
  fields.value("seed", config.seed, "of the samples");
}

}  // namespace saccade
