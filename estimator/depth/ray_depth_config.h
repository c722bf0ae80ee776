#pragma once

#include "core/config/fields.h"
#include "estimator/depth/ray_depth.h"

namespace saccade {

void describe(config::Fields& fields, RayDepthOptions& options);

}  // namespace saccade
