#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/random.h"
#include "estimator/edges/edge_noise.h"
#include "estimator/edges/least_squares/edge_bundle.h"
#include "estimator/edges/least_squares/prior_cost.h"

namespace saccade::testing {

constexpr double kTrueDepth_m = 2.5;

struct SyntheticBundleOptions {
  std::size_t twists = 9;
  bool has_surface = false;
  bool is_robust = true;
  std::size_t edges = 150, events = 41;  ///< events of each edge
  /// Share of the path from which an edge is seen: below 1, from two stretches of half that length
  /// somewhere on it.
  double seen = 1;
};

/// A camera that moves sideways before edges at 2 to 3 m, its path and the depths known with an
/// error. `kSupport` and `kUnknowns` as of EdgeBundle.
template <int kSupport, int kUnknowns>
struct SyntheticBundle {
  using Bundle = EdgeBundle<kSupport, kUnknowns>;

  std::vector<double> path;
  std::vector<typename Bundle::Unknowns> edges;
  std::vector<double> surface = std::vector<double>(9, 1 / kTrueDepth_m);
  Bundle bundle;

  explicit SyntheticBundle(const SyntheticBundleOptions& options)
      : path(6 * options.twists, 0), edges(options.edges), bundle(camera(), path) {
    if (options.has_surface) bundle.keep(surface);
    for (std::size_t e = 0; e < options.edges; ++e) add_edge(e, options);
    add_priors(options.has_surface);
  }

 private:
  static PinholeCamera camera() { return {240, 180, 200, 190, 118, 91, {}}; }

  const Random random_{7};

  void add_edge(std::size_t e, const SyntheticBundleOptions& options) {
    const auto draw = [&](std::uint64_t k) { return random_.uniform(e, k); };
    const Eigen::Vector2d pixel(20 + 180 * draw(0), 20 + 130 * draw(1));
    const double angle = 6.28 * draw(2);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const double depth = kTrueDepth_m + draw(3) - 0.5;
    edges[e].setZero();
    edges[e][0] = 1.03 / depth;
    typename Bundle::Unknowns sigma = Bundle::Unknowns::Constant(0.5);
    sigma.template head<4>() = EdgeNoise::prior_sigma(edges[e][0]);
    std::optional<typename Bundle::SurfaceLink> link;
    if (options.has_surface)
      link = {{&surface[e % 6], &surface[e % 6 + 1], &surface[e % 6 + 2], &surface[e % 6 + 3]},
              {0.4, 0.3, 0.2, 0.1},
              0.05};
    bundle.add_edge(pixel, normal, edges[e].data(), {edges[e], sigma, options.is_robust}, link);
    const Eigen::Vector3d point = depth * camera().ray(pixel);
    const auto segments = path.size() / 6 + 1 - kSupport;
    for (std::size_t i = 0; i < options.events; ++i) {
      double s = static_cast<double>(i) / static_cast<double>(options.events - 1);
      if (options.seen < 1) s = options.seen / 2 * s + (1 - options.seen / 2) * draw(4 + i % 2);
      BundleEvent<kSupport> event;
      event.observation.view_from_camera = Rigid3::exp(
          (Twist() << 0.4 * s - 0.2, 0.1 * s * s, 0.05 * s, 0, 0.03 * s, 0.02 * s).finished());
      // The path that is assumed is off by a smooth error.
      const Rigid3 truth = event.observation.view_from_camera *
                           Rigid3::exp((Twist() << 0.004 * s, -0.003 * s, 0.002 * s * s, 0.001 * s,
                                        0.002 * s * s, -0.001 * s)
                                           .finished());
      const Eigen::Vector3d seen = truth.inverse() * point;
      const bool is_outlier = random_.uniform(e, 100 + i) < 0.05;
      const double noise = (is_outlier ? 6 : 0.3) * (random_.uniform(e, 200 + i) - 0.5);
      event.observation.ray = camera().ray(camera().project(seen) + noise * normal);
      event.observation.lag = i % 2 == 0 ? 1 : -1;
      event.observation.pixel = pixel;
      event.observation.normal = normal;
      event.run_offset = random_.uniform(e, 300 + i) - 0.5;
      event.sigma_px = 0.15;
      const double at = s * static_cast<double>(segments);
      event.first = std::min(static_cast<std::size_t>(at), segments - 1);
      const double f = at - static_cast<double>(event.first);
      if constexpr (kSupport == 2)
        event.weight = {1 - f, f};
      else
        event.weight = Eigen::Vector4d(std::pow(1 - f, 3), 3 * f * f * f - 6 * f * f + 4,
                                       -3 * f * f * f + 3 * f * f + 3 * f + 1, f * f * f) /
                       6;
      (void)bundle.add_event(event);
    }
  }

  void add_priors(bool has_surface) {
    const Matrix6 held = root_of_sigma<6>(Twist::Constant(1e-4));
    const Matrix6 smooth = root_of_sigma<6>(Twist::Constant(0.01));
    bundle.add_factor(std::make_unique<LinearPriorCost<6>>(held, Twist::Zero()), {path.data()});
    for (std::size_t k = 1; 6 * k < path.size(); ++k)
      bundle.add_factor(
          std::make_unique<LinearPriorCost<6>>(smooth, Twist::Zero(), std::vector<double>{-1, 1}),
          {&path[6 * (k - 1)], &path[6 * k]});
    if (!has_surface) return;
    for (std::size_t k = 1; k < surface.size(); ++k)
      bundle.add_factor(std::make_unique<LinearPriorCost<1>>(Eigen::Matrix<double, 1, 1>(20.0),
                                                             Eigen::Matrix<double, 1, 1>(0.0),
                                                             std::vector<double>{-1, 1}),
                        {&surface[k - 1], &surface[k]});
  }
};

}  // namespace saccade::testing
