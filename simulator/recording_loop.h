#pragma once

#include <functional>
#include <span>

#include "simulator/event_log.h"

namespace saccade {

/// Lets `camera` (an EventCamera, or what behaves like one) record what `log` does not hold yet of
/// the time up to `duration_s`, and tells `progress` the time that is reached [s]. Checkpoints are
/// taken between two deliveries of the camera.
template <class Camera>
void record_into(EventLog& log, Camera& camera, double duration_s,
                 const std::function<void(double)>& progress) {
  if (log.reached_s() > 0) camera.resume(log.take_state());
  camera.record(duration_s, [&](std::span<const SensedEvent> events, double t_s) {
    log.append(events);
    // The last delivery is followed by complete().
    if (t_s < duration_s && log.wants_checkpoint())
      log.checkpoint(t_s, [&] { return camera.state(); });
    progress(t_s);
  });
  if constexpr (requires { camera.audit(); })
    log.complete(camera.statistics(), camera.audit());
  else
    log.complete(camera.statistics());
}

}  // namespace saccade
