#include "estimator/odometry/start/plane_search.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "estimator/rotation/rotation_estimator.h"

namespace saccade {
namespace {

constexpr int kSize = 8;
using Parameters = PlaneContrast::Parameters;

/// From this image motion on turn and step are told apart.
constexpr double kTurn_px = 8;
constexpr double kLeastMotion_px = 3;
constexpr double kGrowth = 2;  ///< of the window, at most
constexpr double kStepShares[] = {1, 0.5, 1.5};

/// -log contrast + (slope / sigma)^2 / 2, of parameters in pixels.
class PlaneCost : public ceres::FirstOrderFunction {
 public:
  /// `turns`: the turn is looked for, too.
  PlaneCost(PlaneContrast& contrast, const Parameters& px, double slope_sigma, bool turns)
      : contrast_(contrast), px_(px), slope_sigma_(slope_sigma), turns_(turns) {}

  bool Evaluate(const double* const x, double* cost, double* gradient) const override {
    const Parameters at = Eigen::Map<const Parameters>(x).cwiseQuotient(px_);
    const PlaneContrast::Value value = contrast_.evaluate(at);
    if (!(value.contrast > 0)) return false;
    const Eigen::Vector2d slope = at.tail<2>() / slope_sigma_;
    *cost = -std::log(value.contrast) + slope.squaredNorm() / 2;
    if (gradient != nullptr) {
      Parameters by = -value.gradient / value.contrast;
      by.tail<2>() += slope / slope_sigma_;
      if (!turns_) by.segment<3>(3).setZero();
      Eigen::Map<Parameters>(gradient, kSize) = by.cwiseQuotient(px_);
    }
    return true;
  }
  int NumParameters() const override { return kSize; }

 private:
  PlaneContrast& contrast_;
  Parameters px_;
  double slope_sigma_;
  bool turns_;
};

/// By how much an event moves, RMS, per unit of the parameters [px].
Parameters px_per_parameter(const PlaneContrast& contrast, const PlaneMotion& motion) {
  // Across the viewing direction and, at the edge of the picture's inner half, along it.
  constexpr double kAcross = 0.3;
  const double px = contrast.px_per_rate();
  Parameters scale;
  scale << px, px, kAcross * px, px, px, kAcross * px,
      Eigen::Vector2d::Constant(kAcross * std::max(2.0, px * motion.velocity.norm()));
  return scale;
}

}  // namespace

PlaneSearch::PlaneSearch(const PlaneSearchOptions& options, const PinholeCamera& camera,
                         const Gyroscope& gyroscope)
    : options_(options),
      camera_(camera),
      gyroscope_(gyroscope),
      contrast_(camera, options.blur_px, options.burst_fraction,
                static_cast<std::size_t>(options.samples)) {}

std::span<const Event> PlaneSearch::window(std::span<const Event> events, double duration_s) const {
  const TimeNs end_ns = events.front().t_ns + ns_from_seconds(duration_s);
  const auto end = std::partition_point(events.begin(), events.end(),
                                        [end_ns](const Event& e) { return e.t_ns <= end_ns; });
  return events.first(static_cast<std::size_t>(end - events.begin()));
}

double PlaneSearch::image_motion_px(const PlaneFit& fit) const {
  constexpr int kSteps = 5;
  const PinholeCamera camera = camera_.undistorted();
  const Rigid3 first = fit.motion.reference_from_camera(fit.start_s - fit.middle_s).inverse();
  const Rigid3 last = fit.motion.reference_from_camera(fit.end_s - fit.middle_s).inverse();
  double squares = 0;
  int count = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const Eigen::Vector2d pixel((i % kSteps + 0.5) * camera.width / kSteps,
                                (i / kSteps + 0.5) * camera.height / kSteps);
    const Eigen::Vector3d ray = camera.ray(pixel);
    const double inverse_depth = fit.motion.plane().dot(ray);
    if (!(inverse_depth > 0)) continue;
    const Eigen::Vector3d a = first * (ray / inverse_depth), b = last * (ray / inverse_depth);
    if (!(a.z() > 0) || !(b.z() > 0)) continue;
    squares += (camera.project(a) - camera.project(b)).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

PlaneFit PlaneSearch::first_turn(std::span<const Event> events) const {
  RotationOptions options;
  options.samples = options_.samples;
  options.blur_px = options_.blur_px;
  options.burst_fraction = options_.burst_fraction;
  RotationEstimator estimator(camera_, options);
  const double most = options_.events_per_px * camera_.width * camera_.height;
  std::span<const Event> part =
      events.first(std::min(events.size(), static_cast<std::size_t>(most)));
  PlaneFit fit;
  AngularMotion guess;
  while (true) {
    const RotationEstimate found = estimator.estimate(part, guess);
    fit.start_s = seconds_from_ns(part.front().t_ns);
    fit.end_s = seconds_from_ns(part.back().t_ns);
    fit.middle_s = found.t_s;
    fit.motion.rate = found.turning.rate;
    fit.motion_px = image_motion_px(fit);
    const double duration_s = fit.end_s - fit.start_s;
    if (!found.is_valid || fit.motion_px >= kTurn_px || part.size() == events.size() ||
        duration_s >= options_.max_window_s)
      return fit;
    const double growth = std::clamp(1.1 * kTurn_px / fit.motion_px, 1.1, kGrowth);
    const std::span<const Event> longer =
        window(events, std::min(growth * duration_s, options_.max_window_s));
    if (longer.size() <= part.size()) return fit;
    part = longer;
    guess.rate = fit.motion.rate;
  }
}

PlaneFit PlaneSearch::climbed(std::span<const Event> events, const PlaneFit& guess) {
  contrast_.load(events);
  PlaneFit fit = guess;
  fit.start_s = seconds_from_ns(events.front().t_ns);
  fit.end_s = seconds_from_ns(events.back().t_ns);
  fit.middle_s = contrast_.middle_s();
  fit.motion = guess.motion.seen_at(fit.middle_s - guess.middle_s);
  if (!gyroscope_.is_empty()) fit.motion.rate = felt_rate(fit);
  const Parameters px = px_per_parameter(contrast_, fit.motion);
  Parameters at = PlaneContrast::parameters_of(fit.motion).cwiseProduct(px);
  ceres::GradientProblem problem(
      new PlaneCost(contrast_, px, options_.slope_sigma, gyroscope_.is_empty()));
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::BFGS;
  solver.max_num_iterations = options_.iterations;
  solver.function_tolerance = 1e-5;
  solver.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(solver, problem, at.data(), &summary);
  const Parameters found = at.cwiseQuotient(px);
  fit.motion = PlaneContrast::motion_of(found);
  fit.gain = contrast_.evaluate(found).contrast / contrast_.evaluate(Parameters::Zero()).contrast;
  fit.motion_px = image_motion_px(fit);
  return fit;
}

Eigen::Vector3d PlaneSearch::felt_rate(const PlaneFit& fit) const {
  return gyroscope_.mean_rate(ns_from_seconds(fit.start_s), ns_from_seconds(fit.end_s));
}

std::vector<PlaneFit> PlaneSearch::guesses(const PlaneFit& turn) const {
  std::vector<PlaneFit> guesses;
  if (!gyroscope_.is_empty()) {
    PlaneFit guess = turn;
    guess.motion.rate -= felt_rate(turn);
    guess.motion = guess.motion.with_step_share(1);
    guesses.push_back(guess);
    return guesses;
  }
  for (const double share : kStepShares) {
    guesses.push_back(turn);
    guesses.back().motion = turn.motion.with_step_share(share);
  }
  return guesses;
}

std::vector<PlaneFit> PlaneSearch::find(std::span<const Event> events) {
  std::vector<PlaneFit> fits;
  if (events.empty()) return fits;
  const PlaneFit turn = first_turn(events);
  if (turn.motion_px < kLeastMotion_px) return fits;
  for (PlaneFit fit : guesses(turn)) {
    double duration_s = fit.end_s - fit.start_s;
    while (true) {
      const std::span<const Event> part = window(events, duration_s);
      fit = climbed(part, fit);
      if (fit.motion_px >= 0.9 * options_.motion_px || part.size() == events.size() ||
          duration_s >= options_.max_window_s)
        break;
      const double growth = std::clamp(options_.motion_px / fit.motion_px, 1.1, kGrowth);
      duration_s = std::min(growth * duration_s, options_.max_window_s);
    }
    fits.push_back(fit);
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const PlaneFit& a, const PlaneFit& b) { return a.gain > b.gain; });
  return fits;
}

}  // namespace saccade
