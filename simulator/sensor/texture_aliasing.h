#pragma once

#include <string>

#include "core/camera.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_options.h"

namespace saccade {

/// How many texels one ray of a pixel stands for along the longer side of its footprint: the median
/// over some hundreds of rays along the motion. From two on, textures have detail that the rays
/// skip, and a ray that samples points sees jumps that no sensor would see: aliasing. 0 where less
/// than a quarter of the rays see a texture. Deterministic; takes about a millisecond.
[[nodiscard]] double texels_per_ray(const Scene& scene, const Spline& world_from_camera,
                                    const PinholeCamera& camera, const EventOptions& options);

/// The line that warns of such detail and names the keys to set; "" where there is none to speak of,
/// or where the textures are filtered.
[[nodiscard]] std::string aliasing_warning(double texels_per_ray, const EventOptions& options);

}  // namespace saccade
