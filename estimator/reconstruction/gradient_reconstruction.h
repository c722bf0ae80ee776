#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/image_estimator.h"
#include "estimator/reconstruction/place_levels.h"
#include "estimator/reconstruction/poisson.h"
#include "estimator/reconstruction/reference_grid.h"

namespace saccade {

struct GradientOptions {
  LevelOptions levels;
  double prior_sigma = 0.5;      ///< of either component of the gradient, sqrt(P0) [log units/px]
  double observed_sigma = 0.25;  ///< a pixel is observed when its surest direction is this sure
  Boundary boundary = Boundary::kNeumann;
};

/// The thesis's reconstruction (chapter 6): gradients by a pixel-wise Kalman filter, the image by
/// Poisson's equation. `grid`: the pixels of the view that `finder` finds places in; where it
/// wraps, so does the image.
[[nodiscard]] Reconstruction integrate_gradients(LevelFinder& finder, std::span<const Event> events,
                                                 const Trajectory& world_from_camera,
                                                 const ReferenceGrid& grid,
                                                 const GradientOptions& options,
                                                 const ShareDone& done = {});

/// ... of a view.
class GradientReconstruction : public ImageEstimator {
 public:
  GradientReconstruction(const PinholeCamera& camera, const GradientOptions& options)
      : camera_(camera), options_(options) {}
  [[nodiscard]] Reconstruction reconstruct(const ReconstructionWindow& window) const override;

 private:
  PinholeCamera camera_;
  GradientOptions options_;
};

}  // namespace saccade
