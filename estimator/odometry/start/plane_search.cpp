#include "estimator/odometry/start/plane_search.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "core/time_search.h"
#include "estimator/rotation/rotation_estimator.h"

namespace saccade {
namespace {

constexpr int kSize = 8;
using Parameters = PlaneContrast::Parameters;

/// From this image motion on rotation and translation are distinguished.
constexpr double kRotation_px = 8;
constexpr double kMinMotion_px = 3;
constexpr double kMotion_px = 20;        ///< of the image over the window that is searched for
constexpr double kEventsPerPixel = 0.5;  ///< of the first window
constexpr double kSlopeSigma = 3;  ///< of the plane's slope from 0, where the events hardly say
constexpr int kIterations = 40;    ///< of quasi-Newton steps, at most
constexpr double kGrowth = 2;      ///< of the window, at most
constexpr double kTranslationFractions[] = {1, 0.5, 1.5};

/// -log contrast + (slope / sigma)^2 / 2, of parameters in pixels.
class PlaneCost : public ceres::FirstOrderFunction {
 public:
  /// `finds_rotation`: the rotation is an unknown, too.
  PlaneCost(PlaneContrast& contrast, const Parameters& px, bool finds_rotation)
      : contrast_(contrast), px_(px), finds_rotation_(finds_rotation) {}

  bool Evaluate(const double* const x, double* cost, double* gradient) const override {
    const Parameters at = Eigen::Map<const Parameters>(x).cwiseQuotient(px_);
    const PlaneContrast::Value value = contrast_.evaluate(at);
    if (!(value.contrast > 0)) return false;
    const Eigen::Vector2d slope = at.tail<2>() / kSlopeSigma;
    *cost = -std::log(value.contrast) + slope.squaredNorm() / 2;
    if (gradient != nullptr) {
      Parameters by = -value.gradient / value.contrast;
      by.tail<2>() += slope / kSlopeSigma;
      if (!finds_rotation_) by.segment<3>(3).setZero();
      Eigen::Map<Parameters>(gradient, kSize) = by.cwiseQuotient(px_);
    }
    return true;
  }
  int NumParameters() const override { return kSize; }

 private:
  PlaneContrast& contrast_;
  Parameters px_;
  bool finds_rotation_;
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

/// Whether a longer window has a much lower velocity: a camera that is shaken turns back within it, and no
/// constant velocity explains it.
bool has_turned_back(const PlaneFit& before, const PlaneFit& fit) {
  constexpr double kSlower = 0.7;  // of half a sine the mean is 0.64 of what it begins with
  if (before.motion_px < kMinMotion_px) return false;
  return fit.motion_px * (before.end_s - before.start_s) <
         kSlower * before.motion_px * (fit.end_s - fit.start_s);
}

/// However long an edge takes to pass a pixel, the first of its events counts: with eight unknowns
/// pixels that say "no motion" do more harm than in RotationEstimator.
constexpr BurstLimits kBursts{.gap = 0.15, .longest = 1};

}  // namespace

PlaneSearch::PlaneSearch(double max_window_s, const PinholeCamera& camera,
                         const Gyroscope& gyroscope)
    : max_window_s_(max_window_s),
      camera_(camera),
      gyroscope_(gyroscope),
      contrast_(camera, RotationOptions().blur_px, kBursts,
                static_cast<std::size_t>(RotationOptions().samples)) {}

std::span<const Event> PlaneSearch::window(std::span<const Event> events, double duration_s) const {
  return events.first(count_until(events, events.front().t_ns + ns_from_seconds(duration_s)));
}

double PlaneSearch::image_motion_px(const PlaneFit& fit) const {
  constexpr int kSteps = 5;
  const PinholeCamera camera = camera_.undistorted();
  const Rigid3 first = fit.motion.reference_from_camera(fit.start_s - fit.middle_s).inverse();
  const Rigid3 last = fit.motion.reference_from_camera(fit.end_s - fit.middle_s).inverse();
  double squares = 0;
  int count = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int row = i / kSteps;
    const Eigen::Vector2d pixel((i % kSteps + 0.5) * camera.width / kSteps,
                                (row + 0.5) * camera.height / kSteps);
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

PlaneFit PlaneSearch::first_rotation(std::span<const Event> events) const {
  RotationOptions options;
  options.bursts = kBursts;
  RotationEstimator estimator(camera_, options);
  const double most = kEventsPerPixel * camera_.width * camera_.height;
  std::span<const Event> part =
      events.first(std::min(events.size(), static_cast<std::size_t>(most)));
  PlaneFit fit;
  AngularMotion guess;
  while (true) {
    PlaneFit before = fit;
    const RotationEstimate found = estimator.estimate(part, guess);
    fit.start_s = seconds_from_ns(part.front().t_ns);
    fit.end_s = seconds_from_ns(part.back().t_ns);
    fit.middle_s = found.t_s;
    fit.motion.rate = found.turning.rate;
    fit.motion_px = image_motion_px(fit);
    if (gyroscope_.is_empty() && found.is_valid && has_turned_back(before, fit)) return before;
    const double duration_s = fit.end_s - fit.start_s;
    if (!found.is_valid || fit.motion_px >= kRotation_px || part.size() == events.size() ||
        duration_s >= max_window_s_)
      return fit;
    const double growth = std::clamp(1.1 * kRotation_px / fit.motion_px, 1.1, kGrowth);
    const std::span<const Event> longer =
        window(events, std::min(growth * duration_s, max_window_s_));
    if (longer.size() <= part.size()) return fit;
    part = longer;
    guess.rate = fit.motion.rate;
  }
}

PlaneFit PlaneSearch::maximized(std::span<const Event> events, const PlaneFit& guess) {
  contrast_.load(events);
  PlaneFit fit = guess;
  fit.start_s = seconds_from_ns(events.front().t_ns);
  fit.end_s = seconds_from_ns(events.back().t_ns);
  fit.middle_s = contrast_.middle_s();
  fit.motion = guess.motion.seen_at(fit.middle_s - guess.middle_s);
  if (!gyroscope_.is_empty()) fit.motion.rate = measured_rate(fit);
  const Parameters px = px_per_parameter(contrast_, fit.motion);
  Parameters at = PlaneContrast::parameters_of(fit.motion).cwiseProduct(px);
  ceres::GradientProblem problem(new PlaneCost(contrast_, px, gyroscope_.is_empty()));
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::BFGS;
  solver.max_num_iterations = kIterations;
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

Eigen::Vector3d PlaneSearch::measured_rate(const PlaneFit& fit) const {
  return gyroscope_.mean_rate(ns_from_seconds(fit.start_s), ns_from_seconds(fit.end_s));
}

std::vector<PlaneFit> PlaneSearch::guesses(const PlaneFit& rotation) const {
  std::vector<PlaneFit> guesses;
  if (!gyroscope_.is_empty()) {
    PlaneFit guess = rotation;
    guess.motion.rate -= measured_rate(rotation);
    guess.motion = guess.motion.with_translation_fraction(1);
    guesses.push_back(guess);
    return guesses;
  }
  for (const double fraction : kTranslationFractions) {
    guesses.push_back(rotation);
    guesses.back().motion = rotation.motion.with_translation_fraction(fraction);
  }
  return guesses;
}

std::vector<PlaneFit> PlaneSearch::find(std::span<const Event> events) {
  std::vector<PlaneFit> fits;
  if (events.empty()) return fits;
  const PlaneFit rotation = first_rotation(events);
  if (rotation.motion_px < kMinMotion_px) return fits;
  for (PlaneFit fit : guesses(rotation)) {
    double duration_s = fit.end_s - fit.start_s;
    while (true) {
      const std::span<const Event> part = window(events, duration_s);
      const PlaneFit before = fit;
      fit = maximized(part, fit);
      if (gyroscope_.is_empty() && before.gain > 0 && has_turned_back(before, fit)) {
        fit = before;
        break;
      }
      if (fit.motion_px >= 0.9 * kMotion_px || part.size() == events.size() ||
          duration_s >= max_window_s_)
        break;
      const double growth = std::clamp(kMotion_px / fit.motion_px, 1.1, kGrowth);
      duration_s = std::min(growth * duration_s, max_window_s_);
    }
    fits.push_back(fit);
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const PlaneFit& a, const PlaneFit& b) { return a.gain > b.gain; });
  return fits;
}

}  // namespace saccade
