#include "estimator/reconstruction/gradient_reconstruction.h"

#include <algorithm>
#include <vector>

#include "estimator/reconstruction/gradient_filter.h"
#include "estimator/reconstruction/gradient_images.h"
#include "estimator/stage_clock.h"

namespace saccade {
namespace {

constexpr std::size_t kBatch = 65536;  ///< events whose levels are kept at a time

/// From the pixels' centres to the midpoints between neighbours, where the Laplacian wants them.
GradientField between_pixels(const ImageF& gx, const ImageF& gy) {
  GradientField g{gx, gy};
  for (int y = 0; y < gx.height(); ++y)
    for (int x = 0; x + 1 < gx.width(); ++x) g.x(x, y) = (gx(x, y) + gx(x + 1, y)) / 2;
  for (int y = 0; y + 1 < gy.height(); ++y)
    for (int x = 0; x < gy.width(); ++x) g.y(x, y) = (gy(x, y) + gy(x, y + 1)) / 2;
  return g;
}

}  // namespace

Reconstruction GradientReconstruction::reconstruct(const ReconstructionWindow& window) const {
  double levels_s = 0, filter_s = 0, poisson_s = 0;
  const Rigid3 world_from_reference = window.world_from_reference();
  ImageF reference(camera_.width, camera_.height);
  window.scene.draw(world_from_reference.inverse(), camera_.undistorted(), reference);
  const ReferenceGrid grid(reference, 1, options_.levels.places.same_surface);
  LevelFinder finder(camera_, window.scene, world_from_reference, reference, window.contrast_on,
                     window.contrast_off, options_.levels);
  GradientFilter filter(grid, finder.sorts(), options_.prior_sigma * options_.prior_sigma);
  std::vector<PlaceLevel> levels;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < window.events.size(); begin += kBatch) {
    levels.clear();
    {
      const StageClock clock(levels_s);
      finder.find(window.events.subspan(begin, std::min(kBatch, window.events.size() - begin)),
                  *window.trajectory, levels);
    }
    const StageClock clock(filter_s);
    filter.add(levels);
    count += levels.size();
  }
  Reconstruction result;
  set_gradient(result, camera_, filter.states(), options_.observed_sigma);
  {
    const StageClock clock(poisson_s);
    result.log_image = solve_poisson(
        divergence(between_pixels(result.gradient_x, result.gradient_y)), options_.boundary);
    subtract_mean(result.log_image);
  }
  result.levels = count;
  result.stages_s = {{"levels", levels_s}, {"filter", filter_s}, {"poisson", poisson_s}};
  return result;
}

}  // namespace saccade
