#include "estimator/refinement/edge_adjustment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <ceres/ceres.h>

#include "core/parallel.h"
#include "estimator/refinement/adjustment_costs.h"
#include "estimator/refinement/coarse_surface.h"
#include "estimator/refinement/edge_fit.h"
#include "estimator/refinement/edge_matches.h"
#include "estimator/refinement/node_correction.h"
#include "estimator/refinement/observed_edges.h"
#include "estimator/refinement/robust_spread.h"
#include "estimator/refinement/schur_solver.h"

namespace saccade {
namespace {

constexpr std::size_t kLeastEdges = 30;
constexpr std::size_t kGrain = 16;  ///< edges that a thread takes at a time

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
                const KnownScene& known, const AdjustmentOptions& options)
      : window_(window),
        edges_(edges),
        options_(options),
        known_(known),
        landmarks_(known.landmarks, window.world_from_reference().inverse(), camera.undistorted()),
        correction_(seconds_from_ns(window.events.front().t_ns),
                    seconds_from_ns(window.events.back().t_ns), options.node_spacing_s),
        observed_(window, edges, camera, correction_,
                  {options.pairs, options.given_pairs, known.given_until_s}),
        surface_(observed_.camera(), options.surface_spacing_px, 1 / known.typical_depth_m) {}

  Adjustment solve() {
    Adjustment result;
    result.trajectory = *window_.trajectory;
    result.edges = edges_;
    if (edges_.edges.size() < kLeastEdges) return result;
    add_edges();
    add_nodes();
    if (options_.surface_sigma > 0) add_surface();
    result.residual_before_px = deviation_px();
    const auto summary = solve_by_schur(problem_, ordering_, options_.iterations, 1e-5);
    result.residual_after_px = deviation_px();
    result.ok = summary.IsSolutionUsable();
    if (result.ok) take(result);
    return result;
  }

 private:
  /// Pixels as a motion (v, w).
  [[nodiscard]] Twist sigma_of_px(double px) const {
    Twist sigma;
    sigma.head<3>().setConstant(px * known_.typical_depth_m / observed_.camera().fx);
    sigma.tail<3>().setConstant(px / observed_.camera().fx);
    return sigma;
  }

  /// A root of the information on a node that is off by so much.
  [[nodiscard]] Matrix6 root_of_px(double px) const {
    if (options_.deviations == AdjustmentOptions::Deviations::kPicture)
      return image_motion_root(observed_.camera(), known_.typical_depth_m, px);
    Twist sigma = sigma_of_px(px);
    sigma.tail<3>() *= options_.turn_share;
    return sigma.cwiseInverse().asDiagonal();
  }

  [[nodiscard]] double noise_px(const FittedEdgel& edge) const {
    return std::max(options_.noise_px, static_cast<double>(edge.residual_px));
  }

  void add_edges() {
    const std::size_t all = edges_.edges.size();
    const std::size_t count = std::min(all, static_cast<std::size_t>(options_.edges));
    chosen_.resize(count);
    const auto fitted_at = [&](std::size_t k) -> const FittedEdgel& {
      return edges_.edges[k * all / count];
    };
    parallel_for(
        count, [&](std::size_t k) { chosen_[k].events = observed_.of(fitted_at(k)); }, kGrain);
    for (std::size_t k = 0; k < count; ++k) {
      const FittedEdgel& fitted = fitted_at(k);
      ChosenEdge& edge = chosen_[k];
      edge.pixel = fitted.edge.pixel.cast<double>();
      edge.unknowns = unknowns_of(fitted);
      const double weight = 1 / noise_px(fitted);
      for (std::size_t i = 0; i < edge.events.size();) {
        // One that is left alone is paired with nothing.
        const bool is_pair =
            i + 1 < edge.events.size() && edge.events[i + 1].node == edge.events[i].node;
        add_pair(edge, edge.events[i], edge.events[is_pair ? i + 1 : i],
                 {weight, is_pair ? weight : 0});
        i += is_pair ? 2 : 1;
      }
      add_prior(edge, prior_of(fitted));
    }
  }

  struct ChosenEdge {
    Eigen::Vector2d pixel;
    EdgeUnknowns unknowns;
    std::vector<ChosenEvent> events;
  };

  void add_pair(ChosenEdge& edge, const ChosenEvent& first, const ChosenEvent& second,
                const std::array<double, 2>& weights) {
    const std::array<WeighedEvent, 2> pair = {
        WeighedEvent{first.observation, first.share, weights[0]},
        WeighedEvent{second.observation, second.share, weights[1]}};
    problem_.AddResidualBlock(new EventPairCost(pair, observed_.camera(), options_.outlier),
                              nullptr, correction_.data(first.node),
                              correction_.data(first.node + 1), edge.unknowns.data());
  }

  /// By the landmark that the edge lies on, where there is one.
  [[nodiscard]] EdgePrior prior_of(const FittedEdgel& fitted) const {
    constexpr double kReach_px = 1.5;
    constexpr double kTolerance = 0.1;
    const Edgel& edge = fitted.edge;
    EdgePrior prior{unknowns_of(fitted),
                    {static_cast<double>(edge.inverse_depth), options_.offset_px,
                     options_.tilt_sigma, options_.hysteresis_px}};
    if (options_.landmark_px <= 0) return prior;
    if (const auto* seen = landmarks_.near(edge, kReach_px, kTolerance)) {
      prior.mean[0] = seen->inverse_depth;
      prior.sigma[0] = std::hypot(seen->sigma, options_.landmark_depth * seen->inverse_depth);
      prior.mean[1] = edge.normal.cast<double>().dot(seen->pixel - edge.pixel.cast<double>());
      prior.sigma[1] = options_.landmark_px;
    }
    return prior;
  }

  /// Robust, since not every landmark is on the edge.
  void add_prior(ChosenEdge& edge, const EdgePrior& prior) {
    for (const int first : {0, 2})
      problem_.AddResidualBlock(
          new EdgePriorCost(first, prior.mean.segment<2>(first), prior.sigma.segment<2>(first)),
          new ceres::CauchyLoss(options_.outlier), edge.unknowns.data());
    ordering_->AddElementToGroup(edge.unknowns.data(), 0);
  }

  void add_nodes() {
    const Matrix6 step = root_of_px(options_.step_sigma_px);
    const Matrix6 assumed = root_of_px(options_.pose_sigma_px);
    const Matrix6 held = sigma_of_px(options_.known_sigma_px).cwiseInverse().asDiagonal();
    for (int i = 0; i < correction_.count(); ++i) {
      const bool is_known = correction_.time_s(i) <= known_.until_s;
      problem_.AddResidualBlock(new NodePriorCost(is_known ? held : assumed), nullptr,
                                correction_.data(i));
      if (i > 0)
        problem_.AddResidualBlock(new NodeStepCost(step), nullptr, correction_.data(i - 1),
                                  correction_.data(i));
      ordering_->AddElementToGroup(correction_.data(i), 1);
    }
  }

  /// The event's observation after the correction.
  [[nodiscard]] EdgeObservation moved(const ChosenEvent& event) const {
    EdgeObservation observation = event.observation;
    const auto twist = [&](int node) { return Eigen::Map<const Twist>(correction_.data(node)); };
    observation.view_from_camera =
        observation.view_from_camera *
        Rigid3::exp((1 - event.share) * twist(event.node) + event.share * twist(event.node + 1));
    return observation;
  }

  void add_surface() {
    std::vector<SurfaceEdge> edges;
    for (ChosenEdge& edge : chosen_) edges.push_back({edge.pixel, edge.unknowns.data()});
    surface_.add_to(problem_, edges, options_.surface_sigma);
    // A group of its own: within one Ceres orders by address, which differs from run to run.
    for (double& node : surface_.nodes()) ordering_->AddElementToGroup(&node, 2);
  }

  /// Median of the absolute residuals, as a Gaussian's deviation [px].
  [[nodiscard]] double deviation_px() {
    std::vector<double> residuals;
    for (const ChosenEdge& edge : chosen_)
      for (const ChosenEvent& event : edge.events)
        residuals.push_back(std::abs(edge_residual(moved(event), observed_.camera(), Twist::Zero(),
                                                   edge.unknowns, nullptr)));
    return gaussian_deviation(residuals);
  }

  void take(Adjustment& result) {
    std::vector<StampedPose> poses(window_.trajectory->poses().begin(),
                                   window_.trajectory->poses().end());
    for (StampedPose& pose : poses)
      if (pose.t_s >= correction_.time_s(0))
        pose.world_from_camera = pose.world_from_camera * Rigid3::exp(correction_.at(pose.t_s));
    result.trajectory = Trajectory(std::move(poses));
    const Rigid3 now_from_view = result.trajectory.at_clamped(window_.reference_s).inverse() *
                                 window_.world_from_reference();
    std::vector<std::optional<FittedEdgel>> fitted(edges_.edges.size());
    parallel_for(
        fitted.size(),
        [&](std::size_t k) {
          if (const auto edge = fitted_to_path(edges_.edges[k]))
            fitted[k] = seen_by(now_from_view, *edge, observed_.camera());
        },
        kGrain);
    result.edges.edges.clear();
    for (const std::optional<FittedEdgel>& edge : fitted)
      if (edge) result.edges.edges.push_back(*edge);
  }

  /// The edge in the view as it was, by its events from the corrected path.
  [[nodiscard]] std::optional<FittedEdgel> fitted_to_path(const FittedEdgel& fitted) const {
    std::vector<EdgeObservation> events;
    for (const ChosenEvent& event : observed_.of(fitted)) events.push_back(moved(event));
    const auto unknowns = fit_edge(events, observed_.camera(), unknowns_of(fitted),
                                   prior_of(fitted), noise_px(fitted), options_.outlier);
    if (!unknowns) return std::nullopt;
    return corrected(fitted, *unknowns);
  }

  const ViewWindow& window_;
  const WindowEdgels& edges_;
  AdjustmentOptions options_;
  const KnownScene& known_;
  SeenLandmarks landmarks_;
  NodeCorrection correction_;
  ObservedEdges observed_;
  std::vector<ChosenEdge> chosen_;
  CoarseSurface surface_;
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

}  // namespace

Adjustment adjust(const ViewWindow& window, const WindowEdgels& edges, const PinholeCamera& camera,
                  const KnownScene& known, const AdjustmentOptions& options) {
  return WindowProblem(window, edges, camera, known, options).solve();
}

}  // namespace saccade
