#pragma once

#include <cstdint>
#include <memory>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/ray_depth.h"
#include "estimator/depth/sweep_depth.h"
#include "estimator/depth/thesis_depth.h"

namespace saccade {

/// How the events of a run are cut into windows, one view each.
struct DepthWindowOptions {
  enum class By { kTime, kEvents };
  enum class Reference { kStart, kMiddle, kEnd };

  By by = By::kTime;
  double duration_s = 0.4;                  ///< of kTime: longest; the windows are equally long
  int events = 200000;                      ///< of kEvents: most; the windows hold equally many
  Reference reference = Reference::kStart;  ///< where in its window the view lies
};

/// The configuration of `saccade run depth`; describe() names the keys, ranges and defaults.
struct DepthConfig {
  enum class Method { kThesis, kRays, kSweep };

  Method method = Method::kThesis;
  DepthWindowOptions window;
  DepthLimits limits;
  ThesisDepthOptions thesis;
  RayDepthOptions rays;
  SweepDepthOptions sweep;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, DepthConfig& config);

/// The method that the configuration names. `camera` with its lens; `mean_depth_m` of the scene, >
/// 0.
[[nodiscard]] std::unique_ptr<DepthEstimator> make_depth_estimator(const DepthConfig& config,
                                                                   const PinholeCamera& camera,
                                                                   double mean_depth_m);

}  // namespace saccade
