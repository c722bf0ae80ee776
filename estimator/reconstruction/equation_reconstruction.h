#pragma once

#include "core/camera.h"
#include "estimator/reconstruction/image_estimator.h"
#include "estimator/reconstruction/level_equations.h"

namespace saccade {

/// The image of a view by one linear equation per event, see solve_equations().
class EquationReconstruction : public ImageEstimator {
 public:
  EquationReconstruction(const PinholeCamera& camera, const EquationOptions& options)
      : camera_(camera), options_(options) {}
  [[nodiscard]] Reconstruction reconstruct(const ReconstructionWindow& window) const override;

 private:
  PinholeCamera camera_;
  EquationOptions options_;
};

}  // namespace saccade
