#pragma once

#include "core/config/fields.h"
#include "estimator/refinement/joint_refinement.h"

namespace saccade {

void describe(config::Fields& fields, JointRefinementOptions& options);

}  // namespace saccade
