#pragma once

#include "tests/bench/study/scenario.h"

namespace saccade::study {

/// Coherent primary rays per processor second, in packets of 4 x 4 pixels from the middle of the
/// motion.
struct RayRates {
  double embree;   ///< rtcIntersect16 alone, on packets that are ready
  double visible;  ///< Scene::visible(), from rays in double precision
};

/// Of all threads, through the meshes that are static.
[[nodiscard]] RayRates measure_ray_rates(const Scenario& scenario);

}  // namespace saccade::study
