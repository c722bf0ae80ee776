#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "core/pose_noise.h"
#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// How the events of a run are cut into windows, one view each.
struct ViewWindowOptions {
  enum class Reference { kStart, kMiddle, kEnd, kFrame };

  double duration_s = 0.4;      ///< without `events`
  std::optional<int> events{};  ///< in each; nullopt: all windows are equally long
  /// kFrame: the middle where no frame lies within the window.
  Reference reference = Reference::kStart;
};

void describe(config::Fields& fields, ViewWindowOptions& options);

/// The events that one view is estimated from.
struct ViewWindow {
  std::span<const Event> events;           ///< in order of time, sensor pixels
  const Trajectory* trajectory = nullptr;  ///< world_from_camera; spans the events and reference_s
  double reference_s = 0;                  ///< time of the view, within the events or at their ends
  PoseNoise pose_noise = {};               ///< of the recording that the trajectory is of
  double event_delay_s = 0;                ///< by how much the events come later than what they saw

  [[nodiscard]] Rigid3 world_from_reference() const { return trajectory->at_clamped(reference_s); }
  /// What the events of a time saw.
  [[nodiscard]] Rigid3 world_from_camera(double event_s) const {
    return trajectory->at_clamped(event_s - event_delay_s);
  }
};

/// Those of the events that lie within the poses' time: beyond it no pose is known.
[[nodiscard]] std::span<const Event> within(std::span<const Event> events,
                                            const Trajectory& trajectory);

/// The window of some consecutive events, one at least, with its view where the options place it.
[[nodiscard]] ViewWindow view_of(std::span<const Event> events, const Trajectory& trajectory,
                                 const ViewWindowOptions& options,
                                 const std::vector<StampedFile>& frames);

/// Cuts the stream into consecutive windows that together hold all of it, as few and as equal as
/// the options allow. Windows without events, where the camera was at rest, are left out.
/// `trajectory` spans the events and outlives the windows; `frames` are those of kFrame.
[[nodiscard]] std::vector<ViewWindow> cut_windows(std::span<const Event> events,
                                                  const Trajectory& trajectory,
                                                  const ViewWindowOptions& options,
                                                  const std::vector<StampedFile>& frames = {});

}  // namespace saccade
