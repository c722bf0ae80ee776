#include "estimator/mosaic/mosaic.h"

#include "estimator/reconstruction/place_levels.h"
#include "estimator/reconstruction/reference_grid.h"

namespace saccade {

Reconstruction make_mosaic(const MosaicInput& input, const Panorama& panorama,
                           const MosaicOptions& options, const ShareDone& done) {
  const bool is_gradient = options.method == MosaicOptions::Method::kGradient;
  const ReferenceGrid grid(panorama);
  DirectionLevels finder(input.camera, panorama, input.contrasts.on, input.contrasts.off,
                         is_gradient ? options.gradient.levels : options.equations.levels);
  if (is_gradient)
    return integrate_gradients(finder, input.events, input.world_from_camera, grid,
                               options.gradient, done);
  return solve_equations(finder, input.events, input.world_from_camera, grid, grid,
                         options.equations, done);
}

}  // namespace saccade
