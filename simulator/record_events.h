#pragma once

#include <string>

#include "simulator/camera_recording.h"

namespace saccade {

/// What `auto` stands for in a scene: kAdaptive where a mesh is animated or lights shine on many
/// triangles, else kExact; any other sampling stands for itself. Throws InputError for kExact in an
/// animated scene.
[[nodiscard]] Sampling chosen_sampling(Sampling sampling, const Scene& scene);
/// Why it is that one, in few words.
[[nodiscard]] std::string sampling_reason(Sampling sampling, const Scene& scene);

/// Records the events into the log, from where an interrupted program left off, and writes them
/// from there. The bytes do not depend on interruptions.
EventStatistics record_events(const CameraRecording& recording);

}  // namespace saccade
