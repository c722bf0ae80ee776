#include "estimator/reconstruction/gradient_reconstruction.h"

#include <utility>

#include "core/stopwatch.h"
#include "estimator/reconstruction/gradient_filter.h"
#include "estimator/reconstruction/gradient_images.h"

namespace saccade {

Reconstruction integrate_gradients(LevelFinder& finder, std::span<const Event> events,
                                   const Trajectory& world_from_camera, const ReferenceGrid& grid,
                                   const GradientOptions& options, const ShareDone& done) {
  double filter_s = 0, poisson_s = 0;
  GradientFilter filter(grid, finder.sorts(), options.prior_sigma * options.prior_sigma);
  Reconstruction result;
  const double levels_s = finder.find_all(events, world_from_camera,
                                          [&](std::span<const PlaceLevel> part, double share) {
                                            const ScopedTimer clock(filter_s);
                                            filter.add(part);
                                            result.levels += part.size();
                                            // Poisson's equation takes no time beside this.
                                            if (done) done(share);
                                          });
  set_gradient(result, grid, filter.states(), options.observed_sigma);
  {
    const ScopedTimer clock(poisson_s);
    const bool wraps = grid.wraps();
    result.log_image = solve_poisson(
        divergence(between_pixels(result.gradient_x, result.gradient_y, wraps), wraps),
        wraps ? Boundary::kWrapped : options.boundary);
    subtract_mean(result.log_image);
  }
  result.stages_s = {{"levels", levels_s}, {"filter", filter_s}, {"poisson", poisson_s}};
  return result;
}

Reconstruction GradientReconstruction::reconstruct(const ReconstructionWindow& window) const {
  const Rigid3 world_from_reference = window.world_from_reference();
  ImageF reference(camera_.width, camera_.height);
  window.scene.draw(world_from_reference.inverse(), camera_.undistorted(), reference);
  const ReferenceGrid grid(std::move(reference), 1, options_.levels.places.same_surface);
  SurfaceLevels finder(camera_, window.scene, world_from_reference, grid.inverse_depth(),
                       window.contrast_on, window.contrast_off, options_.levels);
  return integrate_gradients(finder, window.events, *window.trajectory, grid, options_);
}

}  // namespace saccade
