#include "estimator/reconstruction/gradient/gradient_reconstruction.h"

#include "core/stopwatch.h"
#include "estimator/reconstruction/gradient/gradient_filter.h"
#include "estimator/reconstruction/gradient/gradient_images.h"

namespace saccade {

void describe(config::Fields& fields, GradientOptions& options) {
  fields.choice("boundary", options.boundary,
                {{"dirichlet", Boundary::kDirichlet}, {"neumann", Boundary::kNeumann}},
                "Boundary condition of Poisson's equation (6.20): dirichlet sets the image to 0 "
                "around it, as the thesis does; neumann sets the gradient across the border to 0, "
                "which gives better images. A panorama that covers a full revolution wraps "
                "instead.");
}

Reconstruction GradientReconstruction::solve(ObservationSource& source,
                                             std::span<const Event> events,
                                             const Trajectory& world_from_camera,
                                             const ReferenceGrid& grid,
                                             const ProgressCallback& progress) const {
  double filter_s = 0, poisson_s = 0;
  GradientFilter filter(grid, source.kinds(), kGradientPriorSigma * kGradientPriorSigma);
  Reconstruction result;
  // A pixel's gradient takes the observations of all pixels of the sensor in order of time: one band.
  const auto filter_part = [&](std::size_t, std::span<const IntensityObservation> part) {
    const ScopedTimer clock(filter_s);
    filter.add(part);  // (6.7)-(6.12)
    result.observations += part.size();
  };
  // Poisson's equation takes no time beside this.
  const auto done = [&](double fraction) {
    if (progress) progress(fraction);
  };
  const double both_s = source.observe(events, world_from_camera, 1, filter_part, done);
  set_gradient(result, grid, filter.states());
  {
    const ScopedTimer clock(poisson_s);
    const bool wraps = grid.wraps();
    result.log_image = solve_poisson(  // (6.19)
        divergence(between_pixels(result.gradient_x, result.gradient_y, wraps), wraps),
        wraps ? Boundary::kWrapped : options_.boundary);
    subtract_mean(result.log_image);
  }
  result.stages_s = {
      {"observations", both_s - filter_s}, {"filter", filter_s}, {"poisson", poisson_s}};
  return result;
}

}  // namespace saccade
