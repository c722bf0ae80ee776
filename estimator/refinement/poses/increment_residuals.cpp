#include "estimator/refinement/poses/increment_residuals.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace saccade {

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

}  // namespace saccade
