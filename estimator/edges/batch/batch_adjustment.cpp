#include "estimator/edges/batch/batch_adjustment.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "core/time_search.h"
#include "estimator/edges/edge_matches.h"
#include "estimator/edges/edge_noise.h"
#include "estimator/edges/least_squares/bundle_solver.h"
#include "estimator/edges/least_squares/prior_cost.h"
#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/edges/polarity_runs.h"

namespace saccade {
namespace {

constexpr double kPoseSpacing_s = 1e-3;  ///< of a path
constexpr double kTolerance = 1e-6;      ///< of the cost, where a round ends

/// The unknowns of an edge (edge_residual.h) and, last, k [px]: how much farther across the edge each
/// event of a polarity run (polarity_runs.h) lies than the one before. h, the ON/OFF shift, is of the
/// polarity alone.
using BatchEdgeUnknowns = PathBundle::Unknowns;

/// `most` of `count` indices, evenly.
std::vector<std::size_t> evenly(std::size_t count, int most) {
  const std::size_t size = std::min(count, static_cast<std::size_t>(most));
  std::vector<std::size_t> some(size);
  for (std::size_t i = 0; i < size; ++i) some[i] = i * count / size;
  return some;
}

/// Appends `most` of some events, evenly.
void append_evenly(std::span<const std::uint32_t> events, int most,
                   std::vector<std::uint32_t>& chosen) {
  for (const std::size_t i : evenly(events.size(), most)) chosen.push_back(events[i]);
}

/// The path as a smooth spline, every millisecond.
Trajectory smoothed_path(const BatchInput& input, double smoothing_s) {
  const Spline spline = Spline::smooth(input.path, smoothing_s);
  const double length_s = spline.end_s() - spline.start_s();
  const int steps = std::max(1, static_cast<int>(std::ceil(length_s / kPoseSpacing_s)));
  std::vector<StampedPose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = spline.start_s() + length_s * i / steps;
    poses.push_back({t_s, spline.pose(t_s)});
  }
  return Trajectory(std::move(poses));
}

/// An edge of a keyframe, and its unknowns.
struct BatchEdge {
  KeyframeEdge found;
  BatchEdgeUnknowns unknowns;
};

/// One round: the problem of the path's correction and the edges that were found on the path
/// before.
class BatchProblem {
 public:
  BatchProblem(const Trajectory& path, const std::vector<ViewWindow>& windows,
               const std::vector<WindowEdgels>& found, const BatchInput& input,
               const PinholeCamera& camera, const BatchAdjustmentOptions& options)
      : path_(path),
        windows_(windows),
        found_(found),
        camera_(camera),
        undistorted_(camera.undistorted()),
        options_(options),
        depth_m_(input.typical_depth_m),
        given_until_s_(input.given.size() > 1 ? input.given.back().t_s : path.start_s()),
        correction_(SplineKnots::over(path.start_s(), path.end_s(), options.knot_spacing_s)),
        bundle_(undistorted_, correction_.unknowns()) {
    run_positions_.resize(windows.size());
    parallel_for(windows.size(), [&](std::size_t k) {
      run_positions_[k] = run_positions(windows[k].events, camera);
    });
    choose_edges();
    add_edges();
    add_path_priors(input.given);
    if (options.use_imu) add_inertial_factors(input);
  }

  void solve(CostLog& costs, const std::function<void()>& each) {
    const double start_s = costs.now_s();
    const SolverSummary summary =
        solve_bundle(bundle_, options_.solver, {options_.iterations, kTolerance, each});
    costs.add_round(summary.iterations, start_s);
  }

  [[nodiscard]] Trajectory path() const { return correction_.applied(path_); }

  [[nodiscard]] std::optional<InertialAlignment> inertial() const {
    return inertial_factors_ ? std::optional(inertial_factors_->found()) : std::nullopt;
  }

  void judge(BatchAdjustment& result) {
    result.observations = bundle_.events();
    result.knots = correction_.knots();
    std::vector<double> absolute_px;
    double squares = 0;
    bundle_.for_each_residual([&](double residual, double sigma_px) {
      absolute_px.push_back(std::abs(residual) * sigma_px);
      squares += clipped_square(residual);
    });
    if (absolute_px.empty()) return;
    result.residual_px = gaussian_sigma(absolute_px);
    const double spread = squares / static_cast<double>(absolute_px.size());
    result.covariances = path_covariances(bundle_);
    for (auto& covariance : result.covariances) covariance *= spread / options_.information_ratio;
  }

 private:
  /// The sigma of a twist (v, w) whose parts move the image by `px`.
  [[nodiscard]] Twist sigma_of_px(double px) const {
    const double rad = px / undistorted_.fx;
    return (Twist() << Eigen::Vector3d::Constant(rad * depth_m_), Eigen::Vector3d::Constant(rad))
        .finished();
  }

  void choose_edges() {
    const int most =
        std::min(options_.edges, std::max(1, options_.all_edges / static_cast<int>(found_.size())));
    for (std::size_t k = 0; k < found_.size(); ++k)
      for (const std::size_t i : evenly(found_[k].edges.size(), most)) {
        const auto rho = static_cast<double>(found_[k].edges[i].edge.inverse_depth);
        edges_.push_back({{k, i}, {rho, 0, 0, 0, 0}});
      }
  }

  /// Each edge with some of its own events and of those of its matches in later keyframes.
  void add_edges() {
    std::vector<KeyframeEdge> found;
    for (const BatchEdge& edge : edges_) found.push_back(edge.found);
    std::vector<std::vector<KeyframeEdge>> again(edges_.size());
    if (options_.reobserved_keyframes > 0)
      again = reobservations(found, windows_, found_, options_.window_s, undistorted_);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      BatchEdge& edge = edges_[i];
      begin_edge(edge);
      add_events(edge, edge.found, [&](std::span<const std::uint32_t> events) {
        return choose_events(windows_[edge.found.keyframe], events);
      });
      for (const std::size_t a : evenly(again[i].size(), options_.reobserved_keyframes))
        add_events(edge, again[i][a], [&](std::span<const std::uint32_t> events) {
          std::vector<std::uint32_t> chosen;
          append_evenly(events, options_.reobserved_events, chosen);
          return chosen;
        });
    }
  }

  void begin_edge(BatchEdge& edge) {
    const Edgel& found = found_[edge.found.keyframe].edges[edge.found.edge].edge;
    BatchEdgeUnknowns sigma;
    sigma << EdgeNoise::prior_sigma(edge.unknowns[0]), EdgeNoise::kRunSpacingSigma_px;
    bundle_.add_edge(found.pixel.cast<double>(), found.normal.cast<double>(), edge.unknowns.data(),
                     {edge.unknowns, sigma});
  }

  /// Residuals of an edge by some of the events of `observation`: of itself, or of its match in
  /// another keyframe.
  void add_events(BatchEdge& edge, const KeyframeEdge& observation, const auto& choose) {
    const WindowEdgels& found = found_[observation.keyframe];
    const FittedEdgel& observed = found.edges[observation.edge];
    std::vector<std::uint32_t> events(found.events.event.begin() + observed.first,
                                      found.events.event.begin() + observed.last);
    std::sort(events.begin(), events.end());
    const std::vector<std::uint8_t>& positions = run_positions_[observation.keyframe];
    const double mean = mean_run_position(positions, events);
    for (const std::uint32_t e : choose(events))
      add_event(edge, windows_[observation.keyframe].events[e],
                positions[e] > 0 ? positions[e] - mean : 0, EdgeNoise::sigma_px(observed));
  }

  /// Some of an edge's events, given and returned in order of time.
  [[nodiscard]] std::vector<std::uint32_t> choose_events(
      const ViewWindow& window, std::span<const std::uint32_t> events) const {
    const std::size_t given = count_until(events, given_until_s_, [&](std::uint32_t e) {
      return seconds_from_ns(window.events[e].t_ns);
    });
    std::vector<std::uint32_t> chosen;
    append_evenly(events.first(given), options_.given_events_per_edge, chosen);
    append_evenly(events.subspan(given), options_.events_per_edge, chosen);
    return chosen;
  }

  /// `run_offset`: its position in its run above the mean of the edge.
  void add_event(BatchEdge& batch_edge, const Event& event, double run_offset, double sigma_px) {
    const auto& [keyframe, number] = batch_edge.found;
    const ViewWindow& view = windows_[keyframe];
    const Edgel& edge = found_[keyframe].edges[number].edge;
    const double t_s = seconds_from_ns(event.t_ns);
    EdgeObservation observation;
    observation.view_from_camera = view.world_from_reference().inverse() * path_.at_clamped(t_s);
    observation.ray = undistorted_.ray(camera_.undistort({event.x, event.y}));
    observation.lag = event.polarity;
    observation.pixel = edge.pixel.cast<double>();
    observation.normal = edge.normal.cast<double>();
    const SplineKnots::LocalBasis basis = correction_.knots().at(t_s);
    // An event whose ray leads away from the view, by a path that is wrong, is none of the edge.
    (void)bundle_.add_event(
        {observation, event.polarity * run_offset, sigma_px, basis.first, basis.weight});
  }

  void add_path_priors(const std::vector<StampedPose>& given) {
    const Matrix6 weak = root_of_sigma<6>(sigma_of_px(options_.correction_sigma_px));
    for (std::size_t k = 0; k < correction_.knots().controls(); ++k) {
      bundle_.add_factor(std::make_unique<LinearPriorCost<6>>(weak, Twist::Zero()),
                         {correction_.data(k)});
    }
    add_slope_prior();
    const Matrix6 root = root_of_sigma<6>(sigma_of_px(options_.given_sigma_px));
    for (const StampedPose& pose : given) {
      if (pose.t_s < path_.start_s() || pose.t_s > path_.end_s()) continue;
      const SplineKnots::LocalBasis basis = correction_.knots().at(pose.t_s);
      // xi(t) = -log(given^-1 path): the gauge.
      const Twist error = (pose.world_from_camera.inverse() * path_.at_clamped(pose.t_s)).log();
      add_prior(root, -error, basis.weight, basis.first);
    }
  }

  /// A prior on sum_k weight_k c_(first + k) of the correction's controls.
  void add_prior(const Matrix6& root, const Twist& mean, const Eigen::Vector4d& weight,
                 std::size_t first) {
    bundle_.add_factor(std::make_unique<LinearPriorCost<6>>(
                           root, mean, std::vector<double>(weight.begin(), weight.end())),
                       {correction_.data(first), correction_.data(first + 1),
                        correction_.data(first + 2), correction_.data(first + 3)});
  }

  /// c_(k-1) - 2 c_k + c_(k+1) = 0 of the correction's controls: its slope is a random walk.
  void add_slope_prior() {
    const double walk_px = options_.slope_walk_px * std::pow(options_.knot_spacing_s, 1.5);
    const Matrix6 root = root_of_sigma<6>(sigma_of_px(walk_px));
    const std::size_t last = correction_.knots().controls() - 4;
    for (std::size_t k = 0; k <= last + 1; ++k) {
      // Four controls at a time, the last four twice: three of them count.
      const bool is_end = k > last;
      const Eigen::Vector4d weight =
          is_end ? Eigen::Vector4d(0, 1, -2, 1) : Eigen::Vector4d(1, -2, 1, 0);
      add_prior(root, Twist::Zero(), weight, is_end ? last : k);
    }
  }

  void add_inertial_factors(const BatchInput& input) {
    SACCADE_CHECK(input.imu.has_value());
    const InertialAlignment aligned =
        align_inertially(path_, *input.imu, depth_m_, options_.imu_interval_s);
    if (!(aligned.gravity.norm() > 0))
      throw InputError("imu.txt",
                       "the readings of imu.txt cover too little of the path, or do not fit it");
    const bool knows_scale = aligned.status == InertialAlignment::Status::kOk;
    // Neighbouring events err alike and count for less than their number says; samples do not.
    inertial_factors_.emplace(
        path_, correction_.knots(),
        InertialStart{*input.imu, aligned, input.is_metric || !knows_scale, depth_m_},
        options_.imu_interval_s, 1 / std::sqrt(options_.information_ratio));
    inertial_factors_->add_to(bundle_, correction_);
  }

  const Trajectory& path_;
  const std::vector<ViewWindow>& windows_;
  const std::vector<WindowEdgels>& found_;
  const PinholeCamera& camera_;
  PinholeCamera undistorted_;
  const BatchAdjustmentOptions& options_;
  double depth_m_;
  double given_until_s_;
  PathCorrection correction_;
  std::vector<std::vector<std::uint8_t>> run_positions_;  ///< of the windows' events
  std::vector<BatchEdge> edges_;
  std::optional<InertialFactors> inertial_factors_;
  PathBundle bundle_;
};

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
  BatchAdjustment result;
  std::size_t done = 0;
  const auto advance_to = [&](std::size_t step) {
    if (progress && step > done) progress(step - done);
    done = std::max(done, step);
  };
  result.path = smoothed_path(input, options.smoothing_s);
  const std::vector<double> views =
      batch_views(input.keyframe_s, result.path.end_s(), options.window_s);
  for (int i = 0; i < options.rounds; ++i) {
    const Trajectory before = result.path;
    std::vector<ViewWindow> windows;
    for (const double t_s : views)
      windows.push_back({events_of_view(events, t_s, options.window_s), &before, t_s});
    std::vector<WindowEdgels> found(windows.size());
    parallel_for(windows.size(), [&](std::size_t k) { found[k] = depth.find_edgels(windows[k]); });
    BatchProblem problem(before, windows, found, input, camera, options);
    problem.solve(result.costs, [&] { advance_to(done + 1); });
    if (i + 1 == options.rounds) problem.judge(result);
    result.path = problem.path();
    advance_to(options.steps() * static_cast<std::size_t>(i + 1) /
               static_cast<std::size_t>(options.rounds));
    result.inertial = problem.inertial();
  }
  return result;
}

}  // namespace saccade
