#include "estimator/edges/path/batch_adjustment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "core/process/parallel.h"
#include "core/time_search.h"
#include "estimator/edges/least_squares/bundle_solver.h"
#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/edges/path/path_edge_problem.h"

namespace saccade {
namespace {

void judge(PathEdgeProblem& problem, double information_ratio, BatchAdjustment& result) {
  PathBundle& bundle = problem.bundle();
  result.observations = bundle.events();
  result.knots = problem.correction().knots();
  std::vector<double> absolute_px;
  double squares = 0;
  bundle.for_each_residual([&](double residual, double sigma_px) {
    absolute_px.push_back(std::abs(residual) * sigma_px);
    squares += clipped_square(residual);
  });
  if (absolute_px.empty()) return;
  result.residual_px = gaussian_sigma(absolute_px);
  const double spread = squares / static_cast<double>(absolute_px.size());
  result.covariances = path_covariances(bundle);
  for (auto& covariance : result.covariances) covariance *= spread / information_ratio;
}

/// The edges along a path, found in the events around each view.
std::vector<EdgeView> edge_views(std::span<const Event> events, const Trajectory& path,
                                 const std::vector<double>& times_s, const BatchInput& input,
                                 const PinholeCamera& camera, const RayDepth& depth,
                                 const BatchAdjustmentOptions& options) {
  const double given_until_s =
      input.given.size() > 1 ? input.given.back().t_s : EdgeViewOptions{}.given_until_s;
  std::vector<EdgeView> views(times_s.size());
  parallel_for(times_s.size(), [&](std::size_t k) {
    const ViewWindow window{events_of_view(events, times_s[k], options.window_s), &path,
                            times_s[k]};
    views[k] = edge_view(window, depth.find_edgels(window), camera,
                         {options.events_per_edge, options.given_events_per_edge, given_until_s});
  });
  return views;
}

}  // namespace

std::span<const Event> events_of_view(std::span<const Event> events, double t_s, double window_s) {
  return events_between(events, ns_from_seconds(t_s - window_s / 2),
                        ns_from_seconds(t_s + window_s / 2));
}

std::vector<double> batch_views(const std::vector<double>& keyframe_s, double end_s,
                                double window_s) {
  const double least_s = window_s / 4, most_s = window_s / 3;
  std::vector<double> views = {keyframe_s.front()};
  const auto reach = [&](double t_s) {
    const double from_s = views.back(), gap_s = t_s - from_s;
    const int parts = std::max(1, static_cast<int>(std::ceil(gap_s / most_s)));
    for (int i = 1; i <= parts; ++i) views.push_back(from_s + gap_s * i / parts);
  };
  for (const double t_s : keyframe_s)
    if (t_s >= views.back() + least_s) reach(t_s);
  if (views.back() < end_s - most_s) reach(end_s - most_s);
  return views;
}

Matrix6 BatchAdjustment::covariance_at(double t_s) const {
  const SplineKnots::LocalBasis basis = knots.at(t_s);
  Eigen::Matrix<double, 6, 24> by_twists;
  for (Eigen::Index k = 0; k < 4; ++k)
    by_twists.middleCols<6>(6 * k) = basis.weight[k] * Matrix6::Identity();
  return saccade::covariance_at(covariances, basis.first, by_twists);
}

BatchAdjustment adjust_batch(std::span<const Event> events, const BatchInput& input,
                             const PinholeCamera& camera, const RayDepth& depth,
                             const BatchAdjustmentOptions& options,
                             const std::function<void(std::size_t)>& progress) {
  SACCADE_CHECK(!options.use_imu || input.imu.has_value());
  BatchAdjustment result;
  std::size_t done = 0;
  const auto advance_to = [&](std::size_t step) {
    if (progress && step > done) progress(step - done);
    done = std::max(done, step);
  };
  result.path = smoothed_path(input.path, options.smoothing_s);
  const std::vector<double> times_s =
      batch_views(input.keyframe_s, result.path.end_s(), options.window_s);
  for (int i = 0; i < options.rounds; ++i) {
    const Trajectory before = result.path;
    const std::vector<EdgeView> views =
        edge_views(events, before, times_s, input, camera, depth, options);
    PathEdgeProblem problem(before, views, input, camera.undistorted(), options.problem);
    if (options.use_imu)
      problem.add_inertial_sensor(*input.imu, input.is_metric, options.imu_interval_s,
                                  options.information_ratio);
    problem.solve(result.costs, [&] { advance_to(done + 1); });
    if (i + 1 == options.rounds) judge(problem, options.information_ratio, result);
    result.path = problem.path();
    advance_to(options.steps() * static_cast<std::size_t>(i + 1) /
               static_cast<std::size_t>(options.rounds));
    result.inertial = problem.inertial();
  }
  return result;
}

}  // namespace saccade
