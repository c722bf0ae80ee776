#pragma once

#include <vector>

#include "core/spline/spline.h"
#include "simulator/sensor/image_renderer.h"

namespace saccade {

/// The instants whose views average to the frame at `t_s`: the midpoints of equal parts of the
/// exposure, which is centred on `t_s` and cut to the motion's span; as many as keep the image
/// motion between two of them below a quarter of a pixel, but at most 256 (so a blur beyond 64 px
/// is coarser). Just `t_s` where `exposure_s` is 0.
[[nodiscard]] std::vector<double> exposure_times(const ImageRenderer& renderer,
                                                 const Spline& world_from_camera, double t_s,
                                                 double exposure_s);

}  // namespace saccade
