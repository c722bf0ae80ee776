#include "estimator/edges/path/path_edge_problem.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/process/parallel.h"
#include "estimator/edges/edge_fit.h"
#include "estimator/edges/edge_noise.h"
#include "estimator/edges/least_squares/bundle_solver.h"
#include "estimator/edges/least_squares/prior_cost.h"

namespace saccade {
namespace {

constexpr double kPoseSpacing_s = 1e-3;  ///< of a path
constexpr double kTolerance = 1e-6;      ///< of the cost, where the solver ends
constexpr std::size_t kGrain = 64;       ///< edges that a thread takes at a time

}  // namespace

Twist sigma_of_px(double px, const PinholeCamera& camera, double depth_m) {
  const double rad = px / camera.fx;
  return (Twist() << Eigen::Vector3d::Constant(rad * depth_m), Eigen::Vector3d::Constant(rad))
      .finished();
}

Trajectory smoothed_path(std::span<const StampedPose> path, double smoothing_s) {
  const Spline spline = Spline::smooth(path, smoothing_s);
  const double length_s = spline.end_s() - spline.start_s();
  const int steps = std::max(1, static_cast<int>(std::ceil(length_s / kPoseSpacing_s)));
  std::vector<StampedPose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = spline.start_s() + length_s * i / steps;
    poses.push_back({t_s, spline.pose(t_s)});
  }
  return Trajectory(std::move(poses));
}

PathEdgeProblem::PathEdgeProblem(const Trajectory& path, std::span<const EdgeView> views,
                                 const PathInput& input, const PinholeCamera& camera,
                                 const PathEdgeProblemOptions& options)
    : PathEdgeProblem(path, views, input,
                      {SplineKnots::over(path.start_s(), path.end_s(), options.knot_spacing_s)},
                      camera, options) {}

PathEdgeProblem::PathEdgeProblem(const Trajectory& path, std::span<const EdgeView> views,
                                 const PathInput& input, const PathEdgePart& part,
                                 const PinholeCamera& camera, const PathEdgeProblemOptions& options)
    : path_(path),
      views_(views),
      options_(options),
      camera_(camera),
      depth_m_(input.typical_depth_m),
      correction_(part.knots),
      world_from_camera_(path, path.start_s(), path.end_s()),
      bundle_(camera_, correction_.unknowns()) {
  for (const EdgeView& view : views) {
    world_from_view_.push_back(path.at_clamped(view.t_s));
    view_from_world_.push_back(world_from_view_.back().inverse());
  }
  choose_edges(part.first_view);
  add_edges(input.landmarks);
  add_path_priors(input.given);
}

void PathEdgeProblem::add_prior(std::unique_ptr<ceres::CostFunction> cost, std::size_t controls) {
  std::vector<double*> blocks;
  for (std::size_t k = 0; k < controls; ++k) blocks.push_back(correction_.data(k));
  bundle_.add_factor(std::move(cost), std::move(blocks));
}

bool PathEdgeProblem::solve(CostLog& costs, const std::function<void()>& each) {
  const double start_s = costs.now_s();
  const SolverSummary summary =
      solve_bundle(bundle_, options_.solver, {options_.iterations, kTolerance, each});
  costs.add_round(summary.iterations, start_s);
  return summary.is_usable;
}

std::optional<PathInformation> PathEdgeProblem::information_of_views(std::size_t first,
                                                                     std::size_t last) {
  const auto begin_of = [&](std::size_t view) {
    const auto edge = std::partition_point(edges_.begin(), edges_.end(),
                                           [&](const PathEdge& e) { return e.found.view < view; });
    return static_cast<std::size_t>(edge - edges_.begin());
  };
  return path_information(bundle_, begin_of(first), begin_of(last));
}

void PathEdgeProblem::choose_edges(std::size_t first_view) {
  if (views_.empty()) return;
  const int most =
      std::min(options_.edges, std::max(1, options_.all_edges / static_cast<int>(views_.size())));
  for (std::size_t k = first_view; k < views_.size(); ++k)
    for (const std::size_t i : evenly(views_[k].edges.size(), most)) {
      const auto rho = static_cast<double>(views_[k].edges[i].edge.inverse_depth);
      edges_.push_back({{k, i}, {rho, 0, 0, 0, 0}});
    }
}

/// Each edge with its own events and some of those of its matches in later views.
void PathEdgeProblem::add_edges(std::span<const Landmark> landmarks) {
  std::vector<EdgeOfView> found;
  for (const PathEdge& edge : edges_) found.push_back(edge.found);
  std::vector<std::vector<EdgeOfView>> again(edges_.size());
  if (options_.reobserved_views > 0)
    again = reobservations(found, views_, world_from_view_, options_.reobserving, camera_);
  std::vector<std::vector<PathBundle::Event>> events(edges_.size());
  parallel_for(
      edges_.size(), [&](std::size_t i) { events[i] = events_of(edges_[i], again[i]); }, kGrain);
  bundle_.reserve(events);
  std::optional<ProjectedLandmarks> in_view;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    PathEdge& edge = edges_[i];
    const bool is_first_of_view = i == 0 || edges_[i - 1].found.view != edge.found.view;
    if (is_first_of_view) in_view.emplace(landmarks, view_from_world_[edge.found.view], camera_);
    const Edgel& line = this->found(edge.found).edge;
    const EdgePrior prior = edge_prior(line, edge.unknowns.head<4>(), *in_view);
    Unknowns mean, sigma;
    mean << prior.mean, edge.unknowns[4];
    sigma << prior.sigma, EdgeNoise::kRunSpacingSigma_px;
    bundle_.add_edge(line.pixel.cast<double>(), line.normal.cast<double>(), edge.unknowns.data(),
                     {mean, sigma, !landmarks.empty()});
    // An event whose ray leads away from the view, by a path that is wrong, is none of the edge.
    for (const PathBundle::Event& event : events[i]) (void)bundle_.add_event(event);
  }
}

std::vector<PathBundle::Event> PathEdgeProblem::events_of(
    const PathEdge& edge, std::span<const EdgeOfView> reobservations) const {
  std::vector<PathBundle::Event> events;
  const FittedEdgel& own = found(edge.found);
  for (const EdgeEvent& event : views_[edge.found.view].of(own))
    events.push_back(event_of(edge, event, EdgeNoise::sigma_px(own)));
  for (const std::size_t a : evenly(reobservations.size(), options_.reobserved_views)) {
    const FittedEdgel& match = found(reobservations[a]);
    const std::span<const EdgeEvent> all = views_[reobservations[a].view].of(match);
    for (const std::size_t i : evenly(all.size(), options_.reobserved_events))
      events.push_back(event_of(edge, all[i], EdgeNoise::sigma_px(match)));
  }
  return events;
}

PathBundle::Event PathEdgeProblem::event_of(const PathEdge& edge, const EdgeEvent& event,
                                            double sigma_px) const {
  const Edgel& line = found(edge.found).edge;
  EdgeObservation observation;
  observation.view_from_camera =
      view_from_world_[edge.found.view] * world_from_camera_.at(event.t_s);
  observation.ray = Eigen::Vector3f(event.ray_x, event.ray_y, 1).cast<double>();
  observation.lag = static_cast<double>(event.polarity);
  observation.pixel = line.pixel.cast<double>();
  observation.normal = line.normal.cast<double>();
  const SplineKnots::LocalBasis basis = correction_.knots().at(event.t_s);
  return {observation, static_cast<double>(event.run_offset), sigma_px, basis.first, basis.weight};
}

void PathEdgeProblem::add_path_priors(const std::vector<StampedPose>& given) {
  const Matrix6 weak =
      root_of_sigma<6>(sigma_of_px(options_.correction_sigma_px, camera_, depth_m_));
  for (std::size_t k = 0; k < correction_.knots().controls(); ++k) {
    bundle_.add_factor(std::make_unique<LinearPriorCost<6>>(weak, Twist::Zero()),
                       {correction_.data(k)});
  }
  add_slope_prior();
  const Matrix6 root = root_of_sigma<6>(sigma_of_px(options_.given_sigma_px, camera_, depth_m_));
  for (const StampedPose& pose : given) {
    if (pose.t_s < path_.start_s() || pose.t_s > path_.end_s()) continue;
    const SplineKnots::LocalBasis basis = correction_.knots().at(pose.t_s);
    // xi(t) = -log(given^-1 path): the gauge.
    const Twist error = (pose.world_from_camera.inverse() * path_.at_clamped(pose.t_s)).log();
    add_prior(root, -error, basis.weight, basis.first);
  }
}

/// A prior on sum_k weight_k c_(first + k) of the correction's controls.
void PathEdgeProblem::add_prior(const Matrix6& root, const Twist& mean,
                                const Eigen::Vector4d& weight, std::size_t first) {
  bundle_.add_factor(std::make_unique<LinearPriorCost<6>>(
                         root, mean, std::vector<double>(weight.begin(), weight.end())),
                     {correction_.data(first), correction_.data(first + 1),
                      correction_.data(first + 2), correction_.data(first + 3)});
}

/// c_(k-1) - 2 c_k + c_(k+1) = 0 of the correction's controls: its slope is a random walk.
void PathEdgeProblem::add_slope_prior() {
  const double walk_px = options_.slope_walk_px * std::pow(options_.knot_spacing_s, 1.5);
  const Matrix6 root = root_of_sigma<6>(sigma_of_px(walk_px, camera_, depth_m_));
  const std::size_t last = correction_.knots().controls() - 4;
  for (std::size_t k = 0; k <= last + 1; ++k) {
    // Four controls at a time, the last four twice: three of them count.
    const bool is_end = k > last;
    const Eigen::Vector4d weight =
        is_end ? Eigen::Vector4d(0, 1, -2, 1) : Eigen::Vector4d(1, -2, 1, 0);
    add_prior(root, Twist::Zero(), weight, is_end ? last : k);
  }
}

void PathEdgeProblem::add_inertial_sensor(const MountedImu& imu, bool is_metric, double interval_s,
                                          double information_ratio) {
  const InertialAlignment aligned = align_inertially(path_, imu, depth_m_, interval_s);
  if (!(aligned.gravity.norm() > 0))
    throw InputError("imu.txt",
                     "the readings of imu.txt cover too little of the path, or do not fit it");
  const bool knows_scale = aligned.status == InertialAlignment::Status::kOk;
  // Neighbouring events err alike and count for less than their number says; samples do not.
  inertial_factors_.emplace(path_, correction_.knots(),
                            InertialStart{imu, aligned, is_metric || !knows_scale, depth_m_},
                            interval_s, 1 / std::sqrt(information_ratio));
  inertial_factors_->add_to(bundle_, correction_);
}

}  // namespace saccade
