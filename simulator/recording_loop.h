#pragma once

#include <functional>
#include <span>
#include <string>

#include "simulator/event_log.h"

namespace saccade {

/// A camera whose state can be saved while it records, as EventCamera's.
template <class Camera>
concept SavableCamera = requires(Camera camera, std::string state) {
  camera.resume(state);
  state = camera.state();
};

/// Lets `camera` record what `log` does not hold yet of the time up to `duration_s`, and tells
/// `progress` the time that is reached [s]. Checkpoints are taken between two deliveries of the
/// camera. A camera that cannot be saved begins again after an interruption.
template <class Camera>
void record_into(EventLog& log, Camera& camera, double duration_s,
                 const std::function<void(double)>& progress) {
  if constexpr (SavableCamera<Camera>)
    if (log.reached_s() > 0) camera.resume(log.take_state());
  camera.record(duration_s, [&](auto events, double t_s) {
    log.append(events);
    if constexpr (SavableCamera<Camera>)
      // The last delivery is followed by complete().
      if (t_s < duration_s && log.wants_checkpoint()) log.checkpoint(t_s, camera.state());
    progress(t_s);
  });
  log.complete(camera.statistics());
}

}  // namespace saccade
