#pragma once

#include <cstdint>
#include <memory>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/ray_depth.h"
#include "estimator/depth/sweep_depth.h"
#include "estimator/depth/thesis_depth.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// The configuration of `saccade run depth`; describe() names the keys, ranges and defaults.
struct DepthConfig {
  enum class Method { kThesis, kRays, kSweep };

  Method method = Method::kThesis;
  ViewWindowOptions window;
  DepthLimits limits;
  ThesisDepthOptions thesis;
  RayDepthOptions rays;
  SweepDepthOptions sweep;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, DepthConfig& config);

/// The part of it that is the method, for other modules that find depth: all but window and seed.
void describe_depth_method(config::Fields& fields, DepthConfig& config);

/// The method that the configuration names. `camera` with its lens; `mean_depth_m` of the scene, >
/// 0.
[[nodiscard]] std::unique_ptr<DepthEstimator> make_depth_estimator(const DepthConfig& config,
                                                                   const PinholeCamera& camera,
                                                                   double mean_depth_m);

}  // namespace saccade
