#include "estimator/refinement/poses/event_run_residuals.h"

#include <cmath>

#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/refinement/poses/log_intensity_cost.h"
#include "estimator/refinement/poses/visible_surface.h"

namespace saccade {

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

}  // namespace saccade
