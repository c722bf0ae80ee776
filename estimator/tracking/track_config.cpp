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

void describe_template(config::Fields& fields, TemplateOptions& options) {
  fields.choice("splat", options.splat,
                {{"nearest", TemplateOptions::Splat::kNearest},
                 {"bilinear", TemplateOptions::Splat::kBilinear}},
                "how a map point is drawn");
  fields.value("z_test", options.z_test, "nearer points hide the farther ones of their pixel");
  fields.value("blur_size_px", options.blur_size_px, "taps of the Gaussian, odd").range(1, 15);
  fields.expect(options.blur_size_px % 2 == 1, "blur_size_px", "must be odd");
  fields.value("blur_sigma_px", options.blur_sigma_px, "its standard deviation").range(0.1, 10);
  fields.value("min_value", options.min_value, "pixels of the blurred template above it are used")
      .range(1e-6, 1);
  fields
      .value("min_gradient_px", options.min_gradient_px,
             "gradient of the blurred template [1/px] below which a pixel is not used")
      .range(0, 1);
  fields
      .value("redraw_px", options.redraw_px,
             "the template is kept until the view has moved this far; 0: drawn for every frame")
      .range(0, 1000);
}

void describe_event_frame(config::Fields& fields, EventFrameOptions& options) {
  fields.value("ratio", options.ratio, "events per frame and template pixel (4.21)")
      .range(1e-4, 100);
  fields.value("min_events", options.min_events, "of a frame, however little of the map is in view")
      .range(1, 1e9);
  fields.choice("kind", options.kind,
                {{"binary", EventFrameOptions::Kind::kBinary},
                 {"time_surface", EventFrameOptions::Kind::kTimeSurface}},
                "what a pixel holds: that an event fell, or how recent its last one is");
  if (options.kind == EventFrameOptions::Kind::kTimeSurface) {
    fields
        .value("tau_share", options.tau_share,
               "time constant of the decay, as a share of the frame's duration")
        .range(1e-3, 1e3);
    fields.value("tau_s", options.tau_s, "time constant in place of tau_share; ~ takes tau_share")
        .range(1e-6, 1e3);
  } else {
    fields.choice("drawing", options.drawing,
                  {{"nearest", EventFrameOptions::Drawing::kNearest},
                   {"bilinear", EventFrameOptions::Drawing::kBilinear}},
                  "how an undistorted event is drawn");
    fields.value("motion_compensation", options.motion_compensation,
                 "move every event to the frame's time by the predicted velocity");
  }
  fields.choice("window", options.window,
                {{"disjoint", EventFrameOptions::Window::kDisjoint},
                 {"sliding", EventFrameOptions::Window::kSliding}},
                "which events make a frame: the next ones, or the newest ones");
  if (options.window == EventFrameOptions::Window::kSliding)
    fields.value("step", options.step, "share of a sliding frame's events that are new")
        .range(1e-4, 1);
}

void describe_selection(config::Fields& fields, AlignOptions& options) {
  using Kind = SelectionOptions::Kind;
  SelectionOptions& selection = options.selection;
  fields.choice("selection", selection.kind,
                {{"random", Kind::kRandom},
                 {"dense", Kind::kDense},
                 {"semi_dense", Kind::kSemiDense},
                 {"sparse_patches", Kind::kSparsePatches}},
                "which template points are used (fig. 4.1)");
  if (selection.kind == Kind::kSemiDense)
    fields.value("steep_share", selection.steep_share, "share of the points, the steepest of them")
        .above(0)
        .at_most(1);
  if (selection.kind == Kind::kSparsePatches) {
    fields.value("cell_px", selection.cell_px, "each cell of this size has a patch")
        .range(2, 10000);
    fields.value("patch_px", selection.patch_px, "size of a patch").range(1, 1000);
  }
  if (selection.kind != Kind::kRandom)
    fields.value("converged_px", options.converged_px, "a step below it [px] is the last one")
        .range(0, 100);
}

void describe_align(config::Fields& fields, AlignOptions& options) {
  describe_selection(fields, options);
  fields.value("levels", options.levels, "resolutions, coarse to fine; 1 is the full one alone")
      .range(1, 8);
  fields
      .value("samples", options.samples,
             "template points drawn per iteration by the random selection")
      .range(16, 1e6);
  fields
      .value("iterations", options.iterations,
             "of Gauss-Newton: always all of them with random points, else at most")
      .range(1, 1000);
  fields.choice("brightness", options.brightness,
                {{"none", AlignOptions::Brightness::kNone},
                 {"gain", AlignOptions::Brightness::kGain},
                 {"affine", AlignOptions::Brightness::kAffine}},
                "what is solved with the pose: I = gain T + offset");
  fields.choice("hessian", options.hessian,
                {{"samples", AlignOptions::Hessian::kSamples},
                 {"template", AlignOptions::Hessian::kTemplate}},
                "J^T J of the samples of each iteration, or of the template");
  fields
      .value("averaging_from", options.averaging_from,
             "iteration from which steps shrink as 1/n, so that the samples average out")
      .range(0, 1000);
  fields.choice("weights", options.weights,
                {{"none", RobustWeight::kNone},
                 {"huber", RobustWeight::kHuber},
                 {"tukey", RobustWeight::kTukey}},
                "of the residuals, in units of their root mean square");
  fields.value("smooth", options.smooth, "samples read 3 x 3 means of the event frame");
  fields
      .value("min_visible", options.min_visible,
             "share of samples inside the frame below which the frame is lost")
      .range(0, 1);
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

void describe_motion(config::Fields& fields, PredictionOptions& options) {
  fields.choice("prediction", options.prediction,
                {{"none", PredictionOptions::Prediction::kNone},
                 {"constant_velocity", PredictionOptions::Prediction::kConstantVelocity},
                 {"imu", PredictionOptions::Prediction::kImu}},
                "first guess of the next pose");
  if (options.prediction == PredictionOptions::Prediction::kNone) return;
  fields
      .value("agility_px", options.agility_px,
             "change of the image velocity within a second [px/s] that is expected")
      .range(1, 1e6);
  fields
      .value("agility_share", options.agility_share,
             "that, added for each px/s of image velocity: what moves fast is about to turn back")
      .range(0, 1e3);
}

void describe_gyroscope(config::Fields& fields, PredictionOptions& options) {
  if (options.prediction != PredictionOptions::Prediction::kImu) return;
  fields
      .value("gyro_sigma", options.gyro_sigma,
             "what a reading of the gyroscope is off by, its bias included [rad/s]")
      .range(1e-6, 10);
  fields.value("gyro_bias", options.gyro_bias, "taken from every reading [rad/s, sensor frame]");
}

/// How the pose is found from the edges.
void describe_edges(config::Fields& fields, TrackerOptions& options) {
  using config::Fields;
  fields.group(
      "template", [&](Fields& f) { describe_template(f, options.templates); },
      "how the map is drawn into the current view (4.5)");
  fields.group(
      "event_frame", [&](Fields& f) { describe_event_frame(f, options.event_frame); },
      "how events become an image (4.6)");
  fields.group(
      "align", [&](Fields& f) { describe_align(f, options.align); },
      "Lucas-Kanade between the two (4.1-4.3)");
}

void describe_lost(config::Fields& fields, LostOptions& options) {
  fields
      .value("min_inlier_ratio", options.min_inlier_ratio,
             "below it a frame is suspicious; 0.5 is chance")
      .range(0, 1);
  fields.value("frames", options.frames, "suspicious frames in a row that make a loss")
      .range(1, 1e6);
}

/// What is expected of it, and when it is given up.
void describe_expectation(config::Fields& fields, TrackerOptions& tracker) {
  using config::Fields;
  fields.group(
      "motion",
      [&](Fields& f) {
        describe_motion(f, tracker.motion);
        describe_gyroscope(f, tracker.motion);
      },
      "expectation of the next pose");
  fields.expect(!tracker.event_frame.motion_compensation ||
                    tracker.motion.prediction != PredictionOptions::Prediction::kNone,
                "event_frame", "motion_compensation needs a motion.prediction");
  fields.group(
      "lost", [&](Fields& f) { describe_lost(f, tracker.lost); }, "when a pose is called lost");
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

void describe(config::Fields& fields, TrackerOptions& options) {
  describe_edges(fields, options);
  describe_expectation(fields, options);
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
