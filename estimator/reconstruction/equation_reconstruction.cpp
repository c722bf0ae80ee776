#include "estimator/reconstruction/equation_reconstruction.h"

#include <utility>

#include "estimator/reconstruction/reference_grid.h"

namespace saccade {
namespace {

/// The view with `scale` pixels in place of one, the first centred on the first.
PinholeCamera finer(const PinholeCamera& camera, int scale) {
  PinholeCamera fine = camera.undistorted();
  fine.width = scale * (camera.width - 1) + 1;
  fine.height = scale * (camera.height - 1) + 1;
  fine.fx *= scale;
  fine.fy *= scale;
  fine.cx *= scale;
  fine.cy *= scale;
  return fine;
}

}  // namespace

Reconstruction EquationReconstruction::reconstruct(const ReconstructionWindow& window) const {
  const Rigid3 reference_from_world = window.world_from_reference().inverse();
  const auto grid_of = [&](const PinholeCamera& camera, int scale) {
    ImageF inverse_depth(camera.width, camera.height);
    window.scene.draw(reference_from_world, camera, inverse_depth);
    return ReferenceGrid(std::move(inverse_depth), scale, options_.levels.places.same_surface);
  };
  const ReferenceGrid view = grid_of(camera_.undistorted(), 1);
  const ReferenceGrid grid = grid_of(finer(camera_, options_.scale), options_.scale);
  SurfaceLevels finder(camera_, window.scene, reference_from_world.inverse(), view.inverse_depth(),
                       window.contrast_on, window.contrast_off, options_.levels);
  return solve_equations(finder, window.events, *window.trajectory, view, grid, options_);
}

}  // namespace saccade
