#pragma once

#include "simulator/take.h"

namespace saccade {

/// Writes frames, depth maps and motion fields, in parallel; those that an interrupted program left
/// behind complete are kept.
void record_images(const Take& take);

}  // namespace saccade
