#include "estimator/reconstruction/image_solver.h"

namespace saccade {

Reconstruction ImageEstimator::reconstruct(const ReconstructionWindow& window) const {
  const Rigid3 world_from_reference = window.world_from_reference();
  ImageF inverse_depth(camera_.width, camera_.height);
  window.scene.draw(world_from_reference.inverse(), camera_.undistorted(), inverse_depth);
  const ReferenceGrid grid(std::move(inverse_depth));
  SurfaceObservations source(camera_, window.scene, world_from_reference, grid.inverse_depth(),
                             window.thresholds, options_);
  return solver_->solve(source, window.events, *window.trajectory, grid);
}

}  // namespace saccade
