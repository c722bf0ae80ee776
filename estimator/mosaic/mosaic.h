#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/panorama.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/contrasts.h"
#include "estimator/reconstruction/gradient_reconstruction.h"
#include "estimator/reconstruction/level_equations.h"

namespace saccade {

struct MosaicOptions {
  enum class Method {
    kGradient,  ///< pixel-wise Kalman filter and Poisson's equation
    kEquations  ///< one linear equation per event
  };

  Method method = Method::kEquations;
  GradientOptions gradient;  ///< where the panorama wraps, its boundary is kWrapped
  EquationOptions equations;
};

/// What a mosaic is made from.
struct MosaicInput {
  const PinholeCamera& camera;
  std::span<const Event> events;        ///< in order of time, within that of the orientations
  const Trajectory& world_from_camera;  ///< orientations
  Contrasts contrasts;
};

/// The log intensity of what a camera that only turns sees, in all directions of the panorama: the
/// rotation camera (thesis 3.4.1). It is image reconstruction with directions for places, which
/// needs no depth. Few events give a poor image, never an error.
[[nodiscard]] Reconstruction make_mosaic(const MosaicInput& input, const Panorama& panorama,
                                         const MosaicOptions& options, const ShareDone& done = {});

}  // namespace saccade
