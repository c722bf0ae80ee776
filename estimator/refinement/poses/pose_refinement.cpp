#include "estimator/refinement/poses/pose_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "estimator/edges/least_squares/path_covariance.h"
#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/refinement/poses/increment_cost.h"
#include "estimator/refinement/poses/log_intensity_cost.h"

namespace saccade {
namespace {

/// The points of a map that are visible to pixels along a path; asked for in the order of time, for
/// the map is drawn anew as the view moves on.
class VisibleSurface {
 public:
  /// `redraw_px`: motion of the view after which the map is drawn anew. `surface` outlives this.
  VisibleSurface(const MapSurface& surface, const SplineControls& map_from_camera,
                 double redraw_px);

  /// `pixel`, undistorted, and its ray. nullopt where nothing is known, and beside a jump of depth.
  [[nodiscard]] std::optional<MapSurface::Hit> at(double t_s, const Eigen::Vector2f& pixel,
                                                  const Eigen::Vector3d& ray);

 private:
  void draw_from(double t_s);

  const MapSurface& surface_;
  Spline path_;
  double redraw_px_;
  MapView view_;
  bool is_drawn_ = false;
  double t_s_ = 0, drawn_s_ = 0;
  Rigid3 pose_;  ///< at t_s_
};

VisibleSurface::VisibleSurface(const MapSurface& surface, const SplineControls& map_from_camera,
                               double redraw_px)
    : surface_(surface),
      path_(map_from_camera.spline()),
      redraw_px_(redraw_px),
      view_(surface.map(), 1) {}

std::optional<MapSurface::Hit> VisibleSurface::at(double t_s, const Eigen::Vector2f& pixel,
                                                  const Eigen::Vector3d& ray) {
  draw_from(t_s);
  const Eigen::Vector2i node = view_.node_at(pixel);
  if (!view_.contains(node.x(), node.y())) return std::nullopt;
  return surface_.intersect(view_(node.x(), node.y()), pose_, ray);
}

void VisibleSurface::draw_from(double t_s) {
  constexpr double kStep_s = 1e-3;
  if (is_drawn_ && t_s == t_s_) return;
  t_s_ = t_s;
  pose_ = path_.pose(t_s);
  if (is_drawn_ && t_s - drawn_s_ <= kStep_s) return;
  if (!is_drawn_ || view_.moved_px(pose_) > redraw_px_) view_.draw(pose_);
  is_drawn_ = true;
  drawn_s_ = t_s;
}

/// Residuals of brightness-increment images (increment_cost.h). An increment is known to within a
/// threshold: what a pixel went on by after its last event is open at both ends of the window,
/// which makes a triangle of variance C^2 / 6.
class IncrementResiduals {
 public:
  /// `contrast`: C [log units]. `surface` and `images` outlive this.
  IncrementResiduals(const MapSurface& surface, const IncrementImages& images, double contrast,
                     const PoseRefinementOptions& options)
      : surface_(surface), images_(images), contrast_(contrast), options_(options) {}

  /// Those of the points visible from the problem's path, and a weak prior of its control poses.
  void add_to(PathProblem& problem) const;

 private:
  /// The map at a pixel at an end of a window.
  struct Seen {
    MapSurface::Hit hit;
    Eigen::Vector2d slope;  ///< of the map [log units/px]
  };
  using Row = std::vector<std::optional<Seen>>;  ///< as the images' pixels
  [[nodiscard]] Row sample(VisibleSurface& surfaces, double t_s) const;
  [[nodiscard]] double sigma(const Seen& begin, const Seen& end) const;

  const MapSurface& surface_;
  const IncrementImages& images_;
  double contrast_;
  const PoseRefinementOptions& options_;
};

IncrementResiduals::Row IncrementResiduals::sample(VisibleSurface& surfaces, double t_s) const {
  Row row;
  for (const IncrementImages::Pixel& pixel : images_.pixels) {
    std::optional<Seen>& seen = row.emplace_back();
    const auto hit = surfaces.at(t_s, pixel.pixel, pixel.ray);
    if (!hit) continue;
    const SampleWithGradient<double> map = surface_.read(hit->view, hit->pixel);
    if (std::isfinite(map.value)) seen = {*hit, {map.dx, map.dy}};
  }
  return row;
}

double IncrementResiduals::sigma(const Seen& begin, const Seen& end) const {
  // One picture that is misplaced is so at both ends alike.
  const double misplaced = begin.hit.view == end.hit.view
                               ? (end.slope - begin.slope).norm()
                               : std::hypot(begin.slope.norm(), end.slope.norm());
  const double misplacement_sigma = options_.reprojection_sigma_px * misplaced;
  return std::sqrt(options_.log_intensity_sigma * options_.log_intensity_sigma +
                   misplacement_sigma * misplacement_sigma + contrast_ * contrast_ / 6);
}

void IncrementResiduals::add_to(PathProblem& problem) const {
  constexpr double kMinSlope = 0.1;  ///< [log units/px]; less says nothing of the motion
  VisibleSurface surfaces(surface_, problem.path(), PoseRefinementOptions::kRedraw_px);
  const SplineKnots& knots = problem.path().knots;
  MeanDepth depth;
  Row begin;
  for (std::size_t w = 0; w < images_.times_s.size(); ++w) {
    Row end = sample(surfaces, images_.times_s[w]);
    for (std::size_t i = 0; w > 0 && i < images_.pixels.size(); ++i) {
      if (!begin[i] || !end[i]) continue;
      depth.add(surface_, end[i]->hit);
      if (std::max(begin[i]->slope.norm(), end[i]->slope.norm()) < kMinSlope) continue;
      IncrementCost::Observation o;
      o.ray = images_.pixels[i].ray;
      o.begin = {knots.at(images_.times_s[w - 1]), begin[i]->hit};
      o.end = {knots.at(images_.times_s[w]), end[i]->hit};
      o.increment = images_.increment(w - 1, i);
      o.sigma = sigma(*begin[i], *end[i]);
      auto cost = std::make_unique<IncrementCost>(o, problem.path().poses, surface_);
      const auto blocks = problem.corrections(cost->first_control(), cost->blocks());
      problem.add(cost.release(), PoseRefinementOptions::kCauchyScaleOfFrames, blocks, o.sigma);
    }
    begin = std::move(end);
  }
  problem.add_weak_prior(PoseRefinementOptions::kPathSigma_px / surface_.map().camera().fx,
                         depth.value_m());
}

/// Residuals of single events, exactly what they say (log_intensity_cost.h).
class EventRunResiduals {
 public:
  /// `surface` and `observed` outlive this.
  EventRunResiduals(const MapSurface& surface, const EventRunObservations& observed,
                    const PoseRefinementOptions& options)
      : surface_(surface), observed_(observed), options_(options) {}

  /// Those of the points visible from the problem's path, and a weak prior of its control poses. This
  /// outlives the problem's solution.
  void add_to(PathProblem& problem);

 private:
  /// An observation with what it saw of the map.
  struct Seen {
    const EventRunObservation* observation;
    MapSurface::Hit hit;
    double map_log_intensity;
    double sigma;
  };
  void find_surfaces(const SplineControls& path);
  void start_offsets();
  void add_event(const Seen& seen, PathProblem& problem);

  const MapSurface& surface_;
  const EventRunObservations& observed_;
  const PoseRefinementOptions& options_;
  std::vector<double> offsets_;
  std::vector<int> length_;  ///< of a run as far as it is seen
  std::vector<Seen> seen_;
};

void EventRunResiduals::add_to(PathProblem& problem) {
  offsets_.assign(observed_.runs, 0);
  length_.assign(observed_.runs, 0);
  seen_.clear();
  find_surfaces(problem.path());
  start_offsets();
  MeanDepth depth;
  for (const Seen& seen : seen_) {
    depth.add(surface_, seen.hit);
    if (length_[seen.observation->run] > 1) add_event(seen, problem);
  }
  problem.add_weak_prior(PoseRefinementOptions::kPathSigma_px / surface_.map().camera().fx,
                         depth.value_m());
}

void EventRunResiduals::find_surfaces(const SplineControls& path) {
  VisibleSurface surfaces(surface_, path, PoseRefinementOptions::kRedraw_px);
  for (const EventRunObservation& o : observed_.observations) {
    const auto hit = surfaces.at(o.t_s, o.pixel, o.ray);
    if (!hit) continue;
    const SampleWithGradient<double> map = surface_.read(hit->view, hit->pixel);
    if (!std::isfinite(map.value)) continue;
    const double misplaced = options_.reprojection_sigma_px * std::hypot(map.dx, map.dy);
    seen_.push_back({&o, *hit, map.value, std::hypot(options_.log_intensity_sigma, misplaced)});
    ++length_[o.run];
  }
}

void EventRunResiduals::start_offsets() {
  // The middle of what the map shows above the relative log intensities of a run.
  std::vector<std::vector<double>> above(offsets_.size());
  for (const Seen& seen : seen_)
    above[seen.observation->run].push_back(seen.map_log_intensity -
                                           seen.observation->relative_log_intensity);
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    if (!above[i].empty()) offsets_[i] = median_of(above[i]);
}

void EventRunResiduals::add_event(const Seen& seen, PathProblem& problem) {
  const EventRunObservation& o = *seen.observation;
  LogIntensityCost::Observation observation;
  observation.time = problem.path().knots.at(o.t_s);
  for (std::size_t k = 0; k < 4; ++k)
    observation.controls[k] = problem.path().poses[observation.time.first + k];
  observation.ray = o.ray;
  observation.relative_log_intensity = o.relative_log_intensity;
  observation.sigma = seen.sigma;
  observation.hit = seen.hit;
  problem.add(new LogIntensityCost(observation, surface_),
              PoseRefinementOptions::kCauchyScaleOfEvents,
              problem.corrections(observation.time.first, 4), seen.sigma, &offsets_[o.run]);
}

/// Rounds of finding what the path of before saw, and adjusting the path to it.
template <class Residuals>
void refine_by(Residuals& residuals, const PoseRefinementOptions& options, RefinedPath& path) {
  for (int i = 0; i < options.rounds; ++i) {
    PathProblem problem(path.map_from_camera);
    residuals.add_to(problem);
    problem.solve(PoseRefinementOptions::kIterations, path.costs);
    if (i + 1 == options.rounds)
      static_cast<PathEvidence&>(path) = problem.judge(PoseRefinementOptions::kInformationRatio);
    path.map_from_camera = problem.adjusted();
  }
}

}  // namespace

Matrix6 RefinedPath::covariance_at(double t_s) const {
  const SplineKnots::LocalBasis basis = map_from_camera.knots.at(t_s);
  std::array<Rigid3, 4> controls;
  for (std::size_t k = 0; k < 4; ++k) controls[k] = map_from_camera.poses[basis.first + k];
  const PoseOverControls pose = pose_over(basis, controls);
  const Eigen::Matrix3d camera_from_map = pose.world_from_body.rotation_matrix().transpose();
  Eigen::Matrix<double, 6, 24> by_controls = Eigen::Matrix<double, 6, 24>::Zero();
  for (Eigen::Index k = 0; k < 4; ++k) {
    by_controls.block<3, 3>(0, 6 * k) = basis.weight[k] * camera_from_map;
    by_controls.block<3, 3>(3, 6 * k + 3) = pose.rotation_jacobian.middleCols<3>(3 * k);
  }
  return saccade::covariance_at(covariance, basis.first, by_controls);
}

RefinedPath refine_path(const MapSurface& surface, const PinholeCamera& camera,
                        const EventContrast& contrast, std::span<const Event> events,
                        std::span<const StampedPose> start, const PoseRefinementOptions& options) {
  RefinedPath path;
  path.map_from_camera = SplineControls::smooth(start, options.knot_spacing_s);
  if (options.residual == PoseRefinementOptions::Residual::kFrames) {
    const auto images =
        observe_increments(events, camera, contrast, options.window_events, options.increments);
    const double mean_contrast = std::hypot(contrast.on, contrast.off) / std::sqrt(2.0);
    IncrementResiduals residuals(surface, images, mean_contrast, options);
    refine_by(residuals, options, path);
  } else {
    const EventRunObservations observed =
        observe_log_intensity(events, camera, contrast, options.events, options.run_events);
    EventRunResiduals residuals(surface, observed, options);
    refine_by(residuals, options, path);
  }
  return path;
}

}  // namespace saccade
