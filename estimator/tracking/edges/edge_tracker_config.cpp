#include "estimator/tracking/edges/edge_tracker_config.h"

namespace saccade {
namespace {

void describe_alignment(config::Fields& fields, AlignOptions& options) {
  using Kind = SelectionOptions::Kind;
  fields
      .value(
          "samples", options.samples,
          "Template points drawn per iteration by the random selection (thesis 4.3). The cost of "
          "a pose is proportional to samples times iterations; more samples give less noise.")
      .range(16, 1e6);
  fields
      .value("iterations", options.iterations,
             "Gauss-Newton iterations per pose: always all of them with random points, at most so "
             "many with fixed ones.")
      .range(1, 1000);
  fields.choice("selection", options.selection.kind,
                {{"random", Kind::kRandom},
                 {"dense", Kind::kDense},
                 {"semi_dense", Kind::kSemiDense},
                 {"sparse_patches", Kind::kSparsePatches}},
                "Template points that are aligned (fig. 4.1): random ones drawn afresh in every "
                "iteration, all, the steepest half, or patches around the steepest ones.");
  fields.choice(
      "robust_loss", options.robust_loss,
      {{"none", RobustLoss::kNone}, {"huber", RobustLoss::kHuber}, {"tukey", RobustLoss::kTukey}},
      "Loss of the residuals, in units of their root mean square. A robust one helps "
      "where the map is incomplete or wrong.");
  fields
      .value("pyramid_levels", options.pyramid_levels,
             "Resolutions of the alignment, coarse to fine; 1 is the full one alone. Each further "
             "level doubles the distance from which a wrong start is corrected and costs time.")
      .range(1, 8);
}

void describe_gyroscope(config::Fields& fields, MotionModelOptions& options) {
  fields
      .value("gyro_sigma", options.gyro_sigma,
             "Standard deviation of a reading of the gyroscope, its bias included, in rad/s. A "
             "smaller one trusts the gyroscope more.")
      .range(1e-6, 10);
  fields
      .value("gyro_bias", options.gyro_bias,
             "Known bias in rad/s, in the frame of the sensor, which is subtracted from every "
             "reading.")
      .range(-10, 10);
  fields
      .value("gyro_offset_s", options.gyro_offset_s,
             "True time of a reading of the gyroscope minus its time stamp, in seconds.")
      .range(-1, 1);
}

}  // namespace

void describe_edges(config::Fields& fields, EdgeTrackerOptions& options) {
  using Preset = EdgeTrackerOptions::Preset;
  using Kind = EventFrameOptions::Kind;
  using Window = EventFrameOptions::Window;
  fields.choice(
      "preset", options.preset,
      {{"accurate", Preset::kAccurate}, {"fast", Preset::kFast}, {"thesis", Preset::kThesis}},
      "Setting that the other keys start from. accurate and fast are the thesis's with the "
      "improvements of this project; thesis is its method as printed.");
  if (fields.has("preset")) options = edge_preset(options.preset);
  describe_alignment(fields, options.align);
  fields
      .value(
          "event_map_ratio", options.event_frame.event_map_ratio,
          "Events per frame, relative to the template's lit pixels (4.21). A smaller ratio gives "
          "more poses, each of fewer events; a larger one blurs fast motion.")
      .range(1e-4, 100);
  fields.choice(
      "event_frame", options.event_frame.kind,
      {{"binary", Kind::kBinary}, {"time_surface", Kind::kTimeSurface}},
      "Value of a pixel of the event frame: whether an event fell, or how recent its last "
      "event is (thesis chapter 9).");
  fields.choice("event_window", options.event_frame.window,
                {{"disjoint", Window::kDisjoint}, {"sliding", Window::kSliding}},
                "Events of a frame: the next ones, or the newest ones, a quarter of which are new "
                "(thesis chapter 9). Sliding frames give four times the poses.");
  fields
      .value("blur_size_px", options.templates.blur_size_px,
             "Taps of the Gaussian that blurs the template, in pixels; an odd number.")
      .range(1, 15);
  fields.expect(options.templates.blur_size_px % 2 == 1, "blur_size_px", "must be odd");
  fields
      .value("blur_sigma_px", options.templates.blur_sigma_px,
             "Standard deviation of that Gaussian, in pixels. A wider template converges from "
             "farther away and is less precise.")
      .range(0.1, 10);
  fields
      .value("redraw_px", options.templates.redraw_px,
             "Image motion in pixels after which the template is drawn anew; 0 draws it for every "
             "frame. A larger one saves time where the map is large.")
      .range(0, 1000);
  fields
      .value(
          "min_inlier_ratio", options.min_inlier_ratio,
          "Inlier ratio below which a frame is suspicious; three such frames in a row are a loss. "
          "0.5 is chance. A larger one misses fewer losses and reports more that are none.")
      .range(0, 1);
}

void describe(config::Fields& fields, MotionModelOptions& options) {
  using Prediction = MotionModelOptions::Prediction;
  fields.choice(
      "prediction", options.prediction,
      {{"none", Prediction::kNone},
       {"constant_velocity", Prediction::kConstantVelocity},
       {"imu", Prediction::kImu}},
      "Prediction of the next pose: the last one, a Kalman filter with constant velocity, "
      "or that filter with the rotation of the gyroscope.");
  if (options.prediction == Prediction::kNone) return;
  fields
      .value("acceleration_sigma_px", options.acceleration_sigma_px,
             "Standard deviation of the change of the image velocity within a second, in px/s. A "
             "smaller one smooths steady motion; a larger one follows abrupt motion.")
      .range(1, 1e6);
  if (options.prediction == Prediction::kImu) describe_gyroscope(fields, options);
}

void describe(config::Fields& fields, EdgeTrackerOptions& options) {
  describe_edges(fields, options);
  fields.section("motion", options.motion, "Motion model that predicts the next pose.");
}

}  // namespace saccade
