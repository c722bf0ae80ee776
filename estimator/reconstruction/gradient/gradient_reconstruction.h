#pragma once

#include "core/config/fields.h"
#include "estimator/reconstruction/gradient/poisson.h"
#include "estimator/reconstruction/image_solver.h"

namespace saccade {

struct GradientOptions {
  ObservationOptions observations;
  Boundary boundary = Boundary::kDirichlet;  ///< of (6.19), in a view that does not wrap
};

void describe(config::Fields& fields, GradientOptions& options);

/// The thesis's reconstruction (chapter 6): gradients by a pixel-wise Kalman filter, the image by
/// Poisson's equation. The image wraps where the grid does.
class GradientReconstruction : public ImageSolver {
 public:
  explicit GradientReconstruction(const GradientOptions& options) : options_(options) {}
  [[nodiscard]] Reconstruction solve(ObservationSource& source, std::span<const Event> events,
                                     const Trajectory& world_from_camera, const ReferenceGrid& grid,
                                     const ProgressCallback& progress) const override;

 private:
  GradientOptions options_;
};

}  // namespace saccade
