#include "simulator/scene/animation/animation_options.h"

#include "core/config/fields.h"

namespace saccade {

void describe(config::Fields& fields, AnimationOptions& options) {
  fields.value("name", options.name,
               "Name of the animation, or its index from 0 on; saccade info lists those of a file. "
               "An empty one is the first.");
  fields
      .value("start_s", options.start_s,
             "Time of the recording at which the animation starts, in seconds; negative where it "
             "has begun before. Until then the mesh has its first pose.")
      .range(-1e6, 1e6);
  fields.value("speed", options.speed, "Seconds of the animation per second of the recording.")
      .range(1e-3, 1e3);
  fields.value("loop", options.loop,
               "Whether the animation starts again at its end; else the last pose stays.");
}

}  // namespace saccade
