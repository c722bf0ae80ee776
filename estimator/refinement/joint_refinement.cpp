#include "estimator/refinement/joint_refinement.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "estimator/refinement/edge_matches.h"
#include "estimator/refinement/event_steps.h"
#include "estimator/refinement/held_cost.h"
#include "estimator/refinement/keyframe_windows.h"
#include "estimator/refinement/marginal_information.h"
#include "estimator/refinement/path_costs.h"
#include "estimator/refinement/robust_spread.h"
#include "estimator/refinement/schur_solver.h"

namespace saccade {
namespace {

constexpr double kPositionSigma = 1e-3;  ///< of the path, over an interval and depth
constexpr double kPathStep_s = 1e-3;     ///< between the poses of a path

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
Trajectory smooth_path(const JointStart& start, double smoothing_s) {
  const Spline spline = Spline::smooth(start.path, smoothing_s);
  const double length_s = spline.end_s() - spline.start_s();
  const int steps = std::max(1, static_cast<int>(std::ceil(length_s / kPathStep_s)));
  std::vector<StampedPose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = spline.start_s() + length_s * i / steps;
    poses.push_back({t_s, spline.pose(t_s)});
  }
  return Trajectory(std::move(poses));
}

/// An edge of a keyframe as it is adjusted.
struct Adjusted {
  KeyframeEdge found;
  SteppedEdge unknowns;
};

/// One round: the problem of the path's correction and the edges that were found on the path
/// before.
class Problem {
 public:
  Problem(const Trajectory& path, const std::vector<ViewWindow>& windows,
          const std::vector<WindowEdgels>& found, const JointStart& start,
          const PinholeCamera& camera, const JointRefinementOptions& options)
      : path_(path),
        windows_(windows),
        found_(found),
        camera_(camera),
        undistorted_(camera.undistorted()),
        options_(options),
        depth_m_(start.typical_depth_m),
        known_until_s_(start.known.size() > 1 ? start.known.back().t_s : path.start_s()),
        correction_(SplineKnots::over(path.start_s(), path.end_s(), options.knot_spacing_s)) {
    steps_.resize(windows.size());
    parallel_for(windows.size(),
                 [&](std::size_t k) { steps_[k] = event_steps(windows[k].events, camera); });
    choose_edges();
    for (Adjusted& edge : adjusted_) add_edge(edge);
    if (options.again_keyframes > 0) tie_keyframes();
    hold_path(start.known);
    if (options.imu.use) add_readings(start);
  }

  void solve(CostLog& costs, const std::function<void()>& each) {
    const double start_s = costs.now_s();
    const auto summary = solve_by_schur(problem_, ordering_, options_.iterations, 1e-6, each);
    costs.add_round(summary.iterations, start_s);
  }

  [[nodiscard]] Trajectory path() const { return correction_.applied(path_); }

  [[nodiscard]] std::optional<InertialAlignment> inertial() const {
    return readings_ ? std::optional(readings_->found()) : std::nullopt;
  }

  void judge(JointResult& result) {
    result.observations = residuals_.size();
    result.knots = correction_.knots();
    if (residuals_.empty()) return;
    std::vector<double> deviations;
    double squares = 0;
    for (const auto& [id, sigma_px] : residuals_) {
      double value = 0;
      problem_.EvaluateResidualBlock(id, false, nullptr, &value, nullptr);
      deviations.push_back(std::abs(value) * sigma_px);
      squares += bounded_square(value);
    }
    result.residual_px = gaussian_deviation(deviations);
    const double spread = squares / static_cast<double>(residuals_.size());
    result.covariance = spread / options_.information * inverse_information();
  }

 private:
  /// Pixels as a motion (v, w).
  [[nodiscard]] Twist sigma_of_px(double px) const {
    const double turn = px / undistorted_.fx;
    return (Twist() << Eigen::Vector3d::Constant(turn * depth_m_), Eigen::Vector3d::Constant(turn))
        .finished();
  }

  void choose_edges() {
    for (std::size_t k = 0; k < found_.size(); ++k)
      for (const std::size_t i : evenly(found_[k].edges.size(), options_.edges)) {
        const auto rho = static_cast<double>(found_[k].edges[i].edge.inverse_depth);
        adjusted_.push_back({{k, i}, {rho, 0, 0, 0, 0}});
      }
  }

  void add_edge(Adjusted& adjusted) {
    add_events(adjusted, adjusted.found, [&](std::span<const std::uint32_t> events) {
      return choose_events(windows_[adjusted.found.keyframe], events);
    });
    const double rho = adjusted.unknowns[0];
    // Of the depth hardly any hold: where a window says nothing of an edge.
    const SteppedEdge sigma(rho, options_.offset_px, options_.tilt_sigma, options_.hysteresis_px,
                            options_.step_px);
    problem_.AddResidualBlock(new HeldCost<5>(adjusted.unknowns, sigma), nullptr,
                              adjusted.unknowns.data());
    ordering_->AddElementToGroup(adjusted.unknowns.data(), 0);
  }

  /// Against an edge some of the events that were found on `seen`: on itself, or on what another
  /// keyframe sees of it.
  void add_events(Adjusted& adjusted, const KeyframeEdge& seen, const auto& choose) {
    const WindowEdgels& found = found_[seen.keyframe];
    const FittedEdgel& edge = found.edges[seen.edge];
    std::vector<std::uint32_t> events(found.events.event.begin() + edge.first,
                                      found.events.event.begin() + edge.last);
    std::sort(events.begin(), events.end());
    const std::vector<std::uint8_t>& steps = steps_[seen.keyframe];
    const double mean = mean_step(steps, events);
    for (const std::uint32_t e : choose(events))
      add_event(adjusted, windows_[seen.keyframe].events[e], steps[e] > 0 ? steps[e] - mean : 0,
                static_cast<double>(edge.residual_px));
  }

  /// Events of edges that later keyframes see again, against the edge as it was seen first.
  void tie_keyframes() {
    std::vector<KeyframeEdge> edges;
    for (const Adjusted& adjusted : adjusted_) edges.push_back(adjusted.found);
    const auto again = seen_again(edges, windows_, found_, options_.window_s, undistorted_);
    for (std::size_t i = 0; i < adjusted_.size(); ++i)
      for (const std::size_t a : evenly(again[i].size(), options_.again_keyframes))
        add_events(adjusted_[i], again[i][a], [&](std::span<const std::uint32_t> events) {
          std::vector<std::uint32_t> chosen;
          append_evenly(events, options_.again_events, chosen);
          return chosen;
        });
  }

  /// Some of an edge's events, given and returned in order of time.
  [[nodiscard]] std::vector<std::uint32_t> choose_events(
      const ViewWindow& window, std::span<const std::uint32_t> events) const {
    const auto is_known = [&](std::uint32_t e) {
      return seconds_from_ns(window.events[e].t_ns) <= known_until_s_;
    };
    const auto first_open = std::partition_point(events.begin(), events.end(), is_known);
    const auto known = static_cast<std::size_t>(first_open - events.begin());
    std::vector<std::uint32_t> chosen;
    append_evenly(events.first(known), options_.known_events_per_edge, chosen);
    append_evenly(events.subspan(known), options_.events_per_edge, chosen);
    return chosen;
  }

  /// `step`: by which its step of a run is above the mean of the edge.
  void add_event(Adjusted& adjusted, const Event& event, double step, double residual_px) {
    const auto& [keyframe, number] = adjusted.found;
    const ViewWindow& view = windows_[keyframe];
    const Edgel& edge = found_[keyframe].edges[number].edge;
    const double t_s = seconds_from_ns(event.t_ns);
    EdgeObservation observation;
    observation.view_from_camera = view.world_from_reference().inverse() * path_.at_clamped(t_s);
    observation.ray = undistorted_.ray(camera_.undistort({event.x, event.y}));
    observation.lag = event.polarity;
    observation.pixel = edge.pixel.cast<double>();
    observation.normal = edge.normal.cast<double>();
    const double sigma_px = std::max(options_.noise_px, residual_px);
    const SplineKnots::Place place = correction_.knots().at(t_s);
    const auto id = problem_.AddResidualBlock(
        new PathEdgeCost(observation, event.polarity * step, undistorted_, place.weight, sigma_px),
        new ceres::CauchyLoss(options_.outlier), correction_.data(place.first),
        correction_.data(place.first + 1), correction_.data(place.first + 2),
        correction_.data(place.first + 3), adjusted.unknowns.data());
    residuals_.emplace_back(id, sigma_px);
  }

  void hold_path(const std::vector<StampedPose>& known) {
    for (std::size_t k = 0; k < correction_.knots().controls(); ++k) {
      problem_.AddResidualBlock(
          new HeldCost<PathCorrection::kSize>(Twist::Zero(), sigma_of_px(options_.hold_px)),
          nullptr, correction_.data(k));
      ordering_->AddElementToGroup(correction_.data(k), 1);
    }
    hold_slope();
    const Twist sigma = sigma_of_px(options_.known_sigma_px);
    for (const StampedPose& pose : known) {
      if (pose.t_s < path_.start_s() || pose.t_s > path_.end_s()) continue;
      const SplineKnots::Place place = correction_.knots().at(pose.t_s);
      const Twist given = (pose.world_from_camera.inverse() * path_.at_clamped(pose.t_s)).log();
      problem_.AddResidualBlock(new KnownPoseCost(given, place.weight, sigma), nullptr,
                                correction_.data(place.first), correction_.data(place.first + 1),
                                correction_.data(place.first + 2),
                                correction_.data(place.first + 3));
    }
  }

  /// c_(k-1) - 2 c_k + c_(k+1) of the correction's controls, whose slope walks.
  void hold_slope() {
    const Twist sigma = sigma_of_px(options_.bend_px * std::pow(options_.knot_spacing_s, 1.5));
    const std::size_t last = correction_.knots().controls() - 4;
    for (std::size_t k = 0; k <= last + 1; ++k) {
      // Four controls at a time, the last four twice: three of them count.
      const bool is_end = k > last;
      const Eigen::Vector4d weight =
          is_end ? Eigen::Vector4d(0, 1, -2, 1) : Eigen::Vector4d(1, -2, 1, 0);
      const std::size_t first = is_end ? last : k;
      problem_.AddResidualBlock(new KnownPoseCost(Twist::Zero(), weight, sigma), nullptr,
                                correction_.data(first), correction_.data(first + 1),
                                correction_.data(first + 2), correction_.data(first + 3));
    }
  }

  void add_readings(const JointStart& start) {
    SACCADE_CHECK(start.imu.has_value());
    InertialAlignmentOptions alignment;
    alignment.position_sigma = kPositionSigma * depth_m_;
    alignment.interval_s = options_.imu.interval_s;
    const InertialAlignment aligned = align_inertially(path_, *start.imu, alignment);
    if (!(aligned.gravity.norm() > 0))
      throw InputError("joint.imu.use",
                       "the readings of imu.txt cover too little of the path, or do not fit it");
    const bool knows_scale = aligned.status == InertialAlignment::Status::kOk;
    // Neighbouring events err alike and count for less than their number says; readings do not.
    readings_.emplace(
        path_, correction_.knots(),
        InertialRowsStart{*start.imu, aligned, start.is_metric || !knows_scale, depth_m_},
        options_.imu, 1 / std::sqrt(options_.information));
    readings_->add_to(problem_, correction_, *ordering_);
  }

  [[nodiscard]] Eigen::MatrixXd inverse_information() {
    std::vector<double*> controls, edges;
    for (std::size_t k = 0; k < correction_.knots().controls(); ++k)
      controls.push_back(correction_.data(k));
    if (readings_)
      for (double* block : readings_->unknowns()) controls.push_back(block);
    for (Adjusted& edge : adjusted_) edges.push_back(edge.unknowns.data());
    const Eigen::MatrixXd information = marginal_information(problem_, controls, edges);
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    if (factor.info() != Eigen::Success) return {};
    const auto wanted =
        static_cast<Eigen::Index>(PathCorrection::kSize * correction_.knots().controls());
    return factor.solve(Eigen::MatrixXd::Identity(information.rows(), wanted)).topRows(wanted);
  }

  const Trajectory& path_;
  const std::vector<ViewWindow>& windows_;
  const std::vector<WindowEdgels>& found_;
  const PinholeCamera& camera_;
  PinholeCamera undistorted_;
  const JointRefinementOptions& options_;
  double depth_m_;
  double known_until_s_;
  PathCorrection correction_;
  std::vector<std::vector<std::uint8_t>> steps_;  ///< of the windows' events
  std::vector<Adjusted> adjusted_;
  std::optional<InertialRows> readings_;
  std::vector<std::pair<ceres::ResidualBlockId, double>> residuals_;  ///< with their sigma_px
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

}  // namespace

Matrix6 JointResult::covariance_at(double t_s) const {
  if (covariance.size() == 0) return Matrix6::Zero();
  const SplineKnots::Place place = knots.at(t_s);
  Eigen::Matrix<double, 6, 24> by_twists;
  for (Eigen::Index k = 0; k < 4; ++k)
    by_twists.middleCols<6>(6 * k) = place.weight[k] * Matrix6::Identity();
  const auto first = static_cast<Eigen::Index>(PathCorrection::kSize * place.first);
  return by_twists * covariance.block<24, 24>(first, first) * by_twists.transpose();
}

JointResult refine_jointly(std::span<const Event> events, const JointStart& start,
                           const PinholeCamera& camera, const RayDepth& depth,
                           const JointRefinementOptions& options,
                           const std::function<void(std::size_t)>& progress) {
  JointResult result;
  std::size_t done = 0;
  const auto advance_to = [&](std::size_t step) {
    if (progress && step > done) progress(step - done);
    done = std::max(done, step);
  };
  result.path = smooth_path(start, options.smoothing_s);
  const std::vector<double> views =
      views_along(start.keyframe_s, result.path.end_s(), options.window_s);
  for (int i = 0; i < options.rounds; ++i) {
    const Trajectory before = result.path;
    std::vector<ViewWindow> windows;
    for (const double t_s : views)
      windows.push_back({events_around(events, t_s, options.window_s), &before, t_s});
    std::vector<WindowEdgels> found(windows.size());
    parallel_for(windows.size(), [&](std::size_t k) { found[k] = depth.find_edgels(windows[k]); });
    Problem problem(before, windows, found, start, camera, options);
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
