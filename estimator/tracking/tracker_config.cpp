#include "estimator/tracking/tracker_config.h"

namespace saccade {
namespace {

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
  fields
      .value("gyro_offset_s", options.gyro_offset_s, "a reading is of so long after its time stamp")
      .range(-1, 1);
}

void describe_lost(config::Fields& fields, LostOptions& options) {
  fields
      .value("min_inlier_ratio", options.min_inlier_ratio,
             "below it a frame is suspicious; 0.5 is chance")
      .range(0, 1);
  fields.value("frames", options.frames, "suspicious frames in a row that make a loss")
      .range(1, 1e6);
}

}  // namespace

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

void describe(config::Fields& fields, TrackerOptions& options) {
  describe_edges(fields, options);
  describe_expectation(fields, options);
}

}  // namespace saccade
