#include "estimator/refinement/poses/chain_residuals.h"

#include <cmath>

#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/refinement/poses/log_intensity_cost.h"
#include "estimator/refinement/poses/visible_surface.h"

namespace saccade {

void ChainResiduals::add_to(PathProblem& problem) {
  offsets_.assign(levels_.chains, 0);
  length_.assign(levels_.chains, 0);
  seen_.clear();
  find_surfaces(problem.path());
  start_offsets();
  MeanDepth depth;
  for (const Seen& seen : seen_) {
    depth.add(surface_, seen.hit);
    if (length_[seen.observation->chain] > 1) add_event(seen, problem);
  }
  problem.add_weak_prior(PoseRefinementOptions::kPathSigma_px / surface_.map().camera().fx,
                         depth.value_m());
}

void ChainResiduals::find_surfaces(const SplineControls& path) {
  VisibleSurface surfaces(surface_, path, PoseRefinementOptions::kRedraw_px);
  for (const ChainObservation& o : levels_.observations) {
    const auto hit = surfaces.at(o.t_s, o.pixel, o.ray);
    if (!hit) continue;
    const SampleWithGradient<double> map = surface_.read(hit->view, hit->pixel);
    if (!std::isfinite(map.value)) continue;
    const double misplaced = options_.reprojection_sigma_px * std::hypot(map.dx, map.dy);
    seen_.push_back({&o, *hit, map.value, std::hypot(options_.log_intensity_sigma, misplaced)});
    ++length_[o.chain];
  }
}

void ChainResiduals::start_offsets() {
  // The middle of what the map shows above the levels of a chain.
  std::vector<std::vector<double>> excess(offsets_.size());
  for (const Seen& seen : seen_)
    excess[seen.observation->chain].push_back(seen.level - seen.observation->level);
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    if (!excess[i].empty()) offsets_[i] = median_of(excess[i]);
}

void ChainResiduals::add_event(const Seen& seen, PathProblem& problem) {
  const ChainObservation& o = *seen.observation;
  LogIntensityCost::Observation observation;
  observation.time = problem.path().knots.at(o.t_s);
  for (std::size_t k = 0; k < 4; ++k)
    observation.controls[k] = problem.path().poses[observation.time.first + k];
  observation.ray = o.ray;
  observation.level = o.level;
  observation.sigma = seen.sigma;
  observation.hit = seen.hit;
  problem.add(new LogIntensityCost(observation, surface_),
              PoseRefinementOptions::kCauchyScaleOfEvents,
              problem.corrections(observation.time.first, 4), seen.sigma, &offsets_[o.chain]);
}

}  // namespace saccade
