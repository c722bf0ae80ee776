#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/depth/sweep/sweep_depth.h"
#include "estimator/depth/thesis/thesis_depth.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// The configuration of `saccade run depth`; describe() names the keys, ranges and defaults.
struct DepthConfig {
  /// Names of the methods, the rows of the table in depth_config.cpp.
  struct Method {
    static constexpr std::string_view kThesis = "thesis", kRays = "rays", kSweep = "sweep";
  };

  std::string method{Method::kThesis};
  ViewWindowOptions window;
  double parallax_px = 0;  ///< ParallaxDemand::least_px
  DepthLimits limits;
  ThesisDepthOptions thesis;
  RayDepthOptions rays;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, DepthConfig& config);

/// Describes the key `depth_range_m`, a list of two depths.
void describe_depth_range(config::Fields& fields, DepthLimits& limits, std::string_view help);

/// The values of `method`, in the order of the table in depth_config.cpp.
[[nodiscard]] std::vector<std::string_view> depth_method_names();

/// The method that the configuration names. `camera` with its lens; `mean_depth_m` of the scene, >
/// 0.
[[nodiscard]] std::unique_ptr<DepthEstimator> make_depth_estimator(const DepthConfig& config,
                                                                   const PinholeCamera& camera,
                                                                   double mean_depth_m);

}  // namespace saccade
