#include "estimator/depth/ray_depth_config.h"

namespace saccade {
namespace {

void describe_seeds(config::Fields& fields, SeedOptions& options) {
  using Votes = SeedOptions::Votes;
  fields.choice("votes", options.votes, {{"vector", Votes::kVector}, {"count", Votes::kCount}},
                "what an event adds: the direction in which the brightness rises, or one");
  fields
      .value("motion_px", options.motion_px,
             "of a point over the part of the window that votes on its depth")
      .range(1, 1000);
  fields.value("spacing_px", options.spacing_px, "parallax between planes over that part")
      .range(0.1, 100);
  fields.value("blur_px", options.blur_px, "of the votes, deviation of the Gaussian")
      .range(0.1, 20);
  fields.value("min_votes", options.min_votes, "of a ridge, per pixel after the blur").above(0);
  fields.value("min_density", options.min_density, "of a ridge's votes, per pixel of motion")
      .range(0, 100);
  fields.value("min_share", options.min_share, "of the votes of the best plane at the same pixel")
      .range(0, 1);
  fields
      .value("min_alignment", options.min_alignment,
             "least |cos| between an edge's normal and the motion of the rays")
      .range(0, 1);
  fields
      .value("min_parallax_px", options.min_parallax_px,
             "across an edge, deviation over the window: edges with less are not tried")
      .range(0, 100);
}

void describe_regression(config::Fields& fields, RegressionOptions& options) {
  fields.value("radius_px", options.reach.radius_px, "across the edge, of the events that count")
      .range(0.5, 20);
  fields.value("half_length_px", options.reach.half_length_px, "along the edge").range(0.5, 50);
  fields.value("iterations", options.iterations, "of reweighting").range(1, 100);
  fields.value("tilt_prior", options.tilt_prior, "deviation of the tilt; 0: none is sought")
      .range(0, 10);
  fields
      .value("hysteresis_prior_px", options.hysteresis_prior_px,
             "deviation of the shift between ON and OFF events; 0: none is sought")
      .range(0, 10);
  fields
      .value("offset_prior_px", options.offset_prior_px,
             "deviation of the edge from its seed; 0: it stays there")
      .range(0, 100);
}

void describe_ownership(config::Fields& fields, OwnershipOptions& options) {
  fields
      .value("min_share", options.min_share,
             "an edge needs this share of its events for itself; 0 keeps every edge")
      .range(0, 1);
  fields
      .value("same_depth", options.same_depth,
             "edges whose depths differ by less, relatively, share their events")
      .range(0, 1);
}

void describe_fusion(config::Fields& fields, FusionOptions& options) {
  fields.value("radius_px", options.plane.radius_px, "of the neighbourhood; 0: no fusion")
      .range(0, 100);
  fields.value("iterations", options.plane.iterations, "of reweighting").range(1, 100);
  fields.value("min_neighbours", options.min_neighbours, "a point with fewer is dropped")
      .range(0, 1000);
  fields
      .value("model_error", options.plane.model_error,
             "of a surface from its tangent plane, relative")
      .range(0, 1);
  fields.value("sigma_scale", options.sigma_scale, "on the fused deviation").range(0.01, 100);
  fields
      .value("few_weights", options.few_weights,
             "a plane through so few points has twice the variance")
      .range(0, 1000);
  fields.value("few_error", options.few_error, "of a surface through so few points, relative")
      .range(0, 1);
  fields.value("floor", options.floor, "of the deviation, relative").range(0, 1);
  fields
      .value("position_error_px", options.position_error_px,
             "deviation of a point's place, which counts on steep surfaces")
      .range(0, 100);
  fields
      .value("own_share", options.own_share,
             "of a point's distance from its plane, added to its deviation")
      .range(0, 10);
  fields
      .value("scatter_share", options.scatter_share,
             "of what the points around scatter more than they should, added to its deviation")
      .range(0, 10);
  fields
      .value("step_shift_px", options.step_shift_px,
             "of a point on a contour, onto the surface that ends there")
      .range(0, 5);
  fields.value("max_sigma", options.max_sigma, "of a point, relative; others are dropped").above(0);
}

}  // namespace

void describe_propagation(config::Fields& fields, PropagationOptions& options) {
  fields.value("rounds", options.rounds, "of propagation; 0: none").range(0, 100);
  fields.value("radius_px", options.plane.radius_px, "of the neighbourhood").range(0.5, 100);
  fields.value("spacing_px", options.spacing_px, "between edges at the same depth, at least")
      .range(0, 20);
  fields
      .value("min_gap", options.min_gap,
             "to the nearest other surface around, in deviations of the depth from the edge's own "
             "events")
      .range(0, 1000);
  fields.value("max_residual_px", options.max_residual_px, "deviation of an edge's events from it")
      .above(0);
  fields.value("min_neighbours", options.min_neighbours, "a place with fewer is not tried")
      .range(0, 1000);
  fields
      .value("tolerance", options.tolerance, "between a seed's depth and its neighbours', relative")
      .range(0, 10);
  fields
      .value("own_strength", options.own_strength,
             "of a ridge, over the least of seeds, for a depth of its own")
      .range(0, 1000);
  fields.value("own_share", options.own_share, "of the best plane's votes, for a depth of its own")
      .range(0, 1);
  fields.value("own_parallax_px", options.own_parallax_px, "for a depth of its own").range(0, 100);
  fields.value("max_sigma", options.max_sigma, "of an edge's own events, relative").above(0);
}

void describe(config::Fields& fields, RayDepthOptions& options) {
  fields.value("slabs", options.slabs, "parts of a window's time in which events are looked up")
      .range(1, 10000);
  fields.group(
      "seeds", [&](config::Fields& f) { describe_seeds(f, options.seeds); },
      "space sweep around the time of the view");
  fields.group(
      "regression", [&](config::Fields& f) { describe_regression(f, options.refiner.regression); },
      "of a seed's inverse depth");
  fields
      .value("spacing_px", options.refiner.spacing_px, "between edges at the same depth, at least")
      .range(0, 20);
  fields
      .value("max_residual_px", options.refiner.max_residual_px,
             "deviation of an edge's events from it")
      .above(0);
  fields
      .value(
          "max_unseen_px", options.max_unseen_px,
          "that an edge may move without an event around the time of the view: else it was hidden")
      .above(0);
  fields.value("max_sigma", options.refiner.max_sigma, "of an edge's inverse depth, relative")
      .above(0);
  fields.group(
      "ownership", [&](config::Fields& f) { describe_ownership(f, options.ownership); },
      "each event belongs to one edge");
  fields.group(
      "propagation", [&](config::Fields& f) { describe_propagation(f, options.propagation); },
      "of depth to edges beside those that have it");
  fields.group(
      "fusion", [&](config::Fields& f) { describe_fusion(f, options.fusion); },
      "planes through neighbouring points");
}

}  // namespace saccade
