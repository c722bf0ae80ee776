#include "estimator/reconstruction/reconstruction_config.h"

#include "estimator/reconstruction/growth.h"

namespace saccade {
namespace {

void describe_planes(config::Fields& fields, PlaneLabelOptions& options) {
  fields.value("step_cost", options.step_cost, "of a step of depth, per pixel of its length")
      .range(0, 1000);
  fields.value("full_step", options.full_step, "relative; smaller steps cost less, in proportion")
      .range(1e-4, 10);
  fields.value("outlier_cost", options.outlier_cost, "most that a point before the surface costs")
      .range(0, 1000);
  fields.value("hidden_cost", options.hidden_cost, "... and one behind it").range(0, 1000);
  fields.value("model_error", options.model_error, "of surfaces from planes, relative")
      .range(1e-6, 1);
  fields.value("nearness_cost", options.nearness_cost, "of a pixel, per log inverse depth")
      .range(0, 1000);
  fields.value("reach_cost", options.reach_cost, "of a pixel, per pixel from the plane's points")
      .range(0, 1000);
  fields
      .value("steepness_cost", options.steepness_cost,
             "of a pixel, per log inverse depth per pixel")
      .range(0, 1000);
}

void describe_depth(config::Fields& fields, DepthSourceOptions& options) {
  using Propagation = DepthSourceOptions::Propagation;
  fields.choice("propagation", options.propagation,
                {{"surface", Propagation::kSurface}, {"splat", Propagation::kSplat}},
                "from the view where depth is known to others: a surface, or Gaussians (6.3)");
  if (options.propagation == Propagation::kSplat) {
    fields.value("kernel_px", options.kernel_px, "side of a Gaussian, odd (fig. 6.2)").range(1, 99);
    fields.expect(options.kernel_px % 2 == 1, "kernel_px", "must be odd");
  }
  fields.group(
      "planes", [&](config::Fields& f) { describe_planes(f, options.planes); },
      "the map through the points of a depth run: what each pixel's plane costs");
}

void describe_places(config::Fields& fields, PlaceOptions& options) {
  fields.value("redraw_px", options.redraw_px, "motion after which the depth is drawn anew")
      .range(0.1, 100);
  fields
      .value("parallax_px", options.parallax_px,
             "... or after which surfaces have shifted so far against each other")
      .range(0.01, 100);
  fields
      .value("same_surface", options.same_surface,
             "relative difference of depth up to which a place is the one that is seen (z-test)")
      .range(1e-4, 10);
  fields
      .value("step_margin_px", options.step_margin_px,
             "pixels this near to a step of depth say nothing")
      .range(0, 20);
}

}  // namespace

void describe_levels(config::Fields& fields, LevelOptions& options) {
  fields
      .value("event_sigma", options.event_sigma,
             "deviation of what an event says, beside the threshold [log units]")
      .range(1e-4, 10);
  fields
      .value("track_events", options.track_events,
             "events after which a pixel's offset has drifted away")
      .range(1, 1e9);
  fields.value("still", options.still, "pixels that moved without an event are measurements too");
  fields.value("still_px", options.still_px, "they are asked each time they have moved this far")
      .range(0.1, 1000);
  fields.value("still_turns", options.still_turns, "every n-th of them at a time, each in its turn")
      .range(1, 64);
  fields
      .value("still_events", options.still_events,
             "... in proportion more seldom where there are more events per pixel than this")
      .above(0);
  fields
      .value("beyond", options.beyond,
             "a silent pixel's level goes on past its last event, by this share of a threshold")
      .range(0, 1);
}

void describe_gradient(config::Fields& fields, GradientOptions& options) {
  fields.value("prior_sigma", options.prior_sigma, "of a component, sqrt(P0) of (6.6) [1/px]")
      .range(1e-4, 100);
  fields
      .value("observed_sigma", options.observed_sigma,
             "a pixel is observed when its surest direction is this sure [1/px]")
      .range(1e-6, 100);
}

void describe_equations(config::Fields& fields, EquationOptions& options) {
  fields
      .value("thin_px", options.thin_px,
             "levels of a pixel whose places are this near are joined; 0: none are")
      .range(0, 10);
  fields
      .value("smoothness", options.smoothness,
             "deviation of the difference of neighbours, all else unknown [log units]")
      .range(1e-4, 1e4);
  fields
      .value("knee", options.knee,
             "difference of neighbours from which on it counts by its size, not its square")
      .range(1e-6, 1e3);
  fields.value("rounds", options.rounds, "from the second on, outliers count less").range(1, 20);
  fields.value("outlier", options.outlier, "deviations beyond which an equation counts less")
      .range(0.1, 1e6);
  fields
      .value("bound_sigma", options.bound_sigma,
             "deviation beyond a silent pixel's bounds, from the second round on [log units]")
      .range(1e-4, 100);
  fields.value("iterations", options.iterations, "of conjugate gradients, per round")
      .range(1, 10000);
  fields.value("tolerance", options.tolerance, "of their residual").range(1e-9, 1);
  fields.value("prior_sigma", options.prior_sigma, "of a component of the gradient [1/px]")
      .range(1e-4, 100);
  fields
      .value("observed_sigma", options.observed_sigma,
             "a pixel is observed when its surest direction is this sure [1/px]")
      .range(1e-6, 100);
}

void describe_image_method(config::Fields& fields, ReconstructionConfig& config) {
  using Method = ReconstructionConfig::Method;
  fields.choice("method", config.method,
                {{"gradient", Method::kGradient}, {"equations", Method::kEquations}},
                "how the image is found");
  fields.group(
      "depth", [&](config::Fields& f) { describe_depth(f, config.depth); },
      "how depth gets from where it is known to where events are");
  fields.value("contrast_on", config.contrast_on, "C+ [log units]; ~ is the dataset's").above(0);
  fields.value("contrast_off", config.contrast_off, "C-").above(0);
  LevelOptions& levels =
      config.method == Method::kGradient ? config.gradient.levels : config.equations.levels;
  fields.group(
      "levels",
      [&](config::Fields& f) {
        describe_levels(f, levels);
        describe_places(f, levels.places);
      },
      "what events say about the view");
  if (config.method == Method::kGradient)
    fields.group(
        "gradient",
        [&](config::Fields& f) {
          describe_gradient(f, config.gradient);
          f.choice("boundary", config.gradient.boundary,
                   {{"dirichlet", Boundary::kDirichlet}, {"neumann", Boundary::kNeumann}},
                   "of Poisson's equation (6.20)");
        },
        "pixel-wise Kalman filter and Poisson's equation (chapter 6)");
  if (config.method == Method::kEquations)
    fields.group(
        "equations",
        [&](config::Fields& f) {
          f.value("scale", config.equations.scale, "unknowns per pixel and direction").range(1, 4);
          describe_equations(f, config.equations);
          f.value("across", config.equations.across,
                  "as smoothness, across the edge of an occluder")
              .range(1e-4, 1e4);
        },
        "one linear equation per event, least squares");
}

void describe(config::Fields& fields, ReconstructionConfig& config) {
  describe_image_method(fields, config);
  fields.group(
      "window", [&](config::Fields& f) { describe(f, config.window); },
      "part of the events that makes one view");
  fields.value("growth", config.growth,
               "numbers of events of the first window after which a picture is kept");
  check_growth(fields, config.growth);
  fields.value(
      "figures", config.figures,
      "keep what Poisson's equation and the carrying of depth do by themselves (figs. 6.1, "
      "6.2)");
  fields.value("seed", config.seed, "of random numbers; none are drawn");
}

std::unique_ptr<ImageEstimator> make_image_estimator(const ReconstructionConfig& config,
                                                     const PinholeCamera& camera) {
  switch (config.method) {
    case ReconstructionConfig::Method::kGradient:
      return std::make_unique<GradientReconstruction>(camera, config.gradient);
    case ReconstructionConfig::Method::kEquations:
      return std::make_unique<EquationReconstruction>(camera, config.equations);
  }
  return nullptr;
}

}  // namespace saccade
