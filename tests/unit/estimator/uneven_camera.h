#pragma once

#include "core/camera.h"

namespace saccade::testing {

/// Cameras of which every number differs from every other, without lens distortion.
inline PinholeCamera uneven_camera() { return {240, 180, 200, 190, 118, 91, {}}; }
inline PinholeCamera small_uneven_camera() { return {64, 48, 61, 58, 30.7, 24.2, {}}; }

}  // namespace saccade::testing
