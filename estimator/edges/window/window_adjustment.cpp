#include "estimator/edges/window/window_adjustment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/process/parallel.h"
#include "estimator/edges/edge_fit.h"
#include "estimator/edges/edge_matches.h"
#include "estimator/edges/edge_noise.h"
#include "estimator/edges/least_squares/bundle_solver.h"
#include "estimator/edges/least_squares/parallax_prior.h"
#include "estimator/edges/least_squares/prior_cost.h"
#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/edges/window/coarse_surface.h"
#include "estimator/edges/window/image_motion.h"
#include "estimator/edges/window/node_correction.h"
#include "estimator/edges/window/observed_edges.h"

namespace saccade {
namespace {

constexpr std::size_t kMinEdges = 30;    ///< fewer do not constrain a path
constexpr double kCostTolerance = 1e-5;  ///< of the cost, where an adjustment ends
constexpr std::size_t kGrain = 16;       ///< edges that a thread takes at a time

EdgeUnknowns unknowns_of(const FittedEdgel& edge) {
  return {static_cast<double>(edge.edge.inverse_depth), 0, 0, 0};
}

FittedEdgel corrected(FittedEdgel fitted, const EdgeUnknowns& unknowns) {
  Edgel& edge = fitted.edge;
  const Eigen::Vector2f tangent = edge.tangent();
  const auto inverse_depth = static_cast<float>(unknowns[0]);
  edge.pixel += static_cast<float>(unknowns[1]) * edge.normal;
  edge.normal = (edge.normal - static_cast<float>(unknowns[2]) * tangent).normalized();
  fitted.sigma *= inverse_depth / edge.inverse_depth;
  edge.inverse_depth = inverse_depth;
  return fitted;
}

class WindowProblem {
 public:
  WindowProblem(const ViewWindow& window, const WindowEdgels& edges, const PinholeCamera& camera,
                const WindowPriors& priors, const WindowAdjustmentOptions& options)
      : window_(window),
        edges_(edges),
        options_(options),
        priors_(priors),
        landmarks_(priors.landmarks, window.world_from_reference().inverse(), camera.undistorted()),
        correction_(seconds_from_ns(window.events.front().t_ns),
                    seconds_from_ns(window.events.back().t_ns), options.node_spacing_s),
        observed_(window, edges, camera, correction_,
                  [&](double t_s) { return t_s < priors.given_until_s ? options.given_pairs : 1; }),
        surface_(observed_.camera(), options.surface_spacing_px, 1 / priors.typical_depth_m),
        bundle_(observed_.camera(), correction_.unknowns()) {}

  WindowAdjustment solve() {
    WindowAdjustment result;
    result.trajectory = *window_.trajectory;
    result.edges = edges_;
    if (edges_.edges.size() < kMinEdges) return result;
    add_edges();
    add_nodes();
    if (options_.has_parallax_prior && holds_scale()) add_parallax_prior();
    if (options_.surface_sigma > 0) surface_.add_to(bundle_);
    result.residual_before_px = residual_sigma_px();
    result.ok =
        solve_bundle(bundle_, options_.solver, {options_.iterations, kCostTolerance}).is_usable;
    result.residual_after_px = residual_sigma_px();
    is_corrected_ = result.ok;
    if (result.ok) correct(result);
    return result;
  }

  /// All edges that still fit, in the view's pose on `path`, which is the window's as corrected.
  [[nodiscard]] WindowEdgels fitted_to(const Trajectory& path) const {
    const Rigid3 now_from_view =
        path.at_clamped(window_.reference_s).inverse() * window_.world_from_reference();
    std::vector<std::optional<FittedEdgel>> fitted(edges_.edges.size());
    parallel_for(
        fitted.size(),
        [&](std::size_t k) {
          if (const auto edge = fitted_to_path(edges_.edges[k]))
            fitted[k] = transformed(now_from_view, *edge, observed_.camera());
        },
        kGrain);
    WindowEdgels result = edges_;
    result.edges.clear();
    for (const std::optional<FittedEdgel>& edge : fitted)
      if (edge) result.edges.push_back(*edge);
    return result;
  }

 private:
  /// The sigma of a twist (v, w) whose parts move the image by `px`.
  [[nodiscard]] Twist sigma_of_px(double px) const {
    Twist sigma;
    sigma.head<3>().setConstant(px * priors_.typical_depth_m / observed_.camera().fx);
    sigma.tail<3>().setConstant(px / observed_.camera().fx);
    return sigma;
  }

  /// A root of the information on a node with this sigma.
  [[nodiscard]] Matrix6 sqrt_information_of_px(double px) const {
    if (options_.prior_of == WindowAdjustmentOptions::PriorOf::kImageMotion)
      return image_motion_sqrt_information(observed_.camera(), priors_.typical_depth_m, px);
    Twist sigma = sigma_of_px(px);
    sigma.tail<3>() *= options_.rotation_sigma_ratio;
    return root_of_sigma<6>(sigma);
  }

  void add_edges() {
    const std::size_t all = edges_.edges.size();
    const std::size_t count = std::min(all, static_cast<std::size_t>(options_.edges));
    chosen_.resize(count);
    const auto fitted_at = [&](std::size_t k) -> const FittedEdgel& {
      return edges_.edges[k * all / count];
    };
    parallel_for(
        count, [&](std::size_t k) { choose(fitted_at(k), chosen_[k]); }, kGrain);
    for (std::size_t k = 0; k < count; ++k) {
      const FittedEdgel& fitted = fitted_at(k);
      ChosenEdge& edge = chosen_[k];
      const Eigen::Vector2d pixel = fitted.edge.pixel.cast<double>();
      // Robust, since not every landmark is on the edge.
      const EdgePrior prior = prior_of(fitted);
      edge.depth_sigma = prior.sigma[0];
      std::optional<WindowBundle::SurfaceLink> link;
      if (options_.surface_sigma > 0) {
        link = surface_.link(pixel, options_.surface_sigma);
        edge.depth_sigma = options_.surface_sigma / priors_.typical_depth_m;
      }
      bundle_.add_edge(pixel, fitted.edge.normal.cast<double>(), edge.unknowns.data(),
                       {prior.mean, prior.sigma, true}, link);
      for (const WindowBundle::Event& event : edge.events) (void)bundle_.add_event(event);
    }
  }

  struct ChosenEdge {
    EdgeUnknowns unknowns;
    std::vector<WindowBundle::Event> events;
    double depth_sigma = 0;  ///< before its events, of its inverse depth [1/m]
  };

  void choose(const FittedEdgel& fitted, ChosenEdge& edge) const {
    edge.unknowns = unknowns_of(fitted);
    const double sigma_px = EdgeNoise::sigma_px(fitted);
    for (const ObservedEvent& event : observed_.of(fitted))
      edge.events.push_back({event.observation,
                             0,
                             sigma_px,
                             static_cast<std::size_t>(event.node),
                             {1 - event.fraction, event.fraction}});
  }

  [[nodiscard]] EdgePrior prior_of(const FittedEdgel& fitted) const {
    return edge_prior(fitted.edge, unknowns_of(fitted), landmarks_);
  }

  void add_nodes() {
    const Matrix6 smooth = sqrt_information_of_px(options_.smoothness_sigma_px);
    const Matrix6 active = sqrt_information_of_px(options_.pose_sigma_px);
    const Matrix6 fixed = root_of_sigma<6>(sigma_of_px(options_.fixed_sigma_px));
    for (int i = 0; i < correction_.count(); ++i) {
      const bool is_fixed = correction_.time_s(i) <= priors_.fixed_until_s;
      bundle_.add_factor(
          std::make_unique<LinearPriorCost<6>>(is_fixed ? fixed : active, Twist::Zero()),
          {correction_.data(i)});
      if (i > 0)
        bundle_.add_factor(
            std::make_unique<LinearPriorCost<6>>(smooth, Twist::Zero(), std::vector<double>{-1, 1}),
            {correction_.data(i - 1), correction_.data(i)});
    }
  }

  /// By the given poses of the run, or a start's surface, whose depth is the unit. Nothing else
  /// would keep the parallax prior from shortening the path, most where no landmark is known yet.
  [[nodiscard]] bool holds_scale() const {
    return options_.surface_sigma > 0 || priors_.given_until_s != kNoGivenPoses;
  }

  void add_parallax_prior() {
    FreeSurface surface;
    if (options_.surface_sigma > 0)
      surface = {CoarseSurface::kRoughness / priors_.typical_depth_m,
                 std::max(1.0, static_cast<double>(chosen_.size()) /
                                   static_cast<double>(surface_.nodes().size()))};
    ParallaxPrior prior(observed_.camera(), static_cast<std::size_t>(correction_.count()), surface);
    for (const ChosenEdge& edge : chosen_)
      prior.add_edge(edge.depth_sigma, std::span<const WindowBundle::Event>(edge.events));
    for (int i = 0; i < correction_.count(); ++i) {
      const ParallaxPrior::OnTwist twist = prior.on(static_cast<std::size_t>(i));
      bundle_.add_factor(std::make_unique<LinearPriorCost<6>>(twist.root, twist.mean),
                         {correction_.data(i)});
    }
  }

  /// The event's observation after the correction.
  [[nodiscard]] EdgeObservation moved(const ObservedEvent& event) const {
    EdgeObservation observation = event.observation;
    if (!is_corrected_) return observation;
    const auto twist = [&](int node) { return Eigen::Map<const Twist>(correction_.data(node)); };
    observation.view_from_camera =
        observation.view_from_camera * Rigid3::exp((1 - event.fraction) * twist(event.node) +
                                                   event.fraction * twist(event.node + 1));
    return observation;
  }

  /// Median of the absolute residuals, as the sigma of a Gaussian [px].
  [[nodiscard]] double residual_sigma_px() const {
    std::vector<double> absolute_px;
    bundle_.for_each_residual([&](double residual, double sigma_px) {
      absolute_px.push_back(std::abs(residual) * sigma_px);
    });
    return gaussian_sigma(absolute_px);
  }

  void correct(WindowAdjustment& result) {
    std::vector<StampedPose> poses(window_.trajectory->poses().begin(),
                                   window_.trajectory->poses().end());
    for (StampedPose& pose : poses)
      if (pose.t_s >= correction_.time_s(0))
        pose.world_from_camera = pose.world_from_camera * Rigid3::exp(correction_.at(pose.t_s));
    result.trajectory = Trajectory(std::move(poses));
    if (options_.fits_edges) result.edges = fitted_to(result.trajectory);
  }

  /// The edge in the view as it was, by its events from the corrected path.
  [[nodiscard]] std::optional<FittedEdgel> fitted_to_path(const FittedEdgel& fitted) const {
    std::vector<EdgeObservation> events;
    for (const ObservedEvent& event : observed_.of(fitted)) events.push_back(moved(event));
    const auto unknowns = fit_edge(events, observed_.camera(), unknowns_of(fitted),
                                   prior_of(fitted), EdgeNoise::sigma_px(fitted));
    if (!unknowns) return std::nullopt;
    return corrected(fitted, *unknowns);
  }

  const ViewWindow& window_;
  const WindowEdgels& edges_;
  WindowAdjustmentOptions options_;
  const WindowPriors& priors_;
  ProjectedLandmarks landmarks_;
  NodeCorrection correction_;
  bool is_corrected_ = false;
  ObservedEdges observed_;
  std::vector<ChosenEdge> chosen_;
  CoarseSurface surface_;
  WindowBundle bundle_;
};

}  // namespace

WindowAdjustment adjust_window(const ViewWindow& window, const WindowEdgels& edges,
                               const PinholeCamera& camera, const WindowPriors& priors,
                               const WindowAdjustmentOptions& options) {
  return WindowProblem(window, edges, camera, priors, options).solve();
}

WindowEdgels edges_on_path(const ViewWindow& window, const WindowEdgels& edges,
                           const PinholeCamera& camera, const WindowPriors& priors,
                           const WindowAdjustmentOptions& options) {
  return WindowProblem(window, edges, camera, priors, options).fitted_to(*window.trajectory);
}

}  // namespace saccade
