#include "estimator/mosaic/mosaic.h"

namespace saccade {

Reconstruction make_mosaic(const MosaicInput& input, const Panorama& panorama,
                           const MosaicOptions& options, const ProgressCallback& progress) {
  const ReferenceGrid grid(panorama);
  PanoramaObservations source(input.camera, panorama, input.thresholds, options.observations());
  return make_image_solver(options)->solve(source, input.events, input.world_from_camera, grid,
                                           progress);
}

}  // namespace saccade
