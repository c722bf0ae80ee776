#pragma once

#include "simulator/camera_recording.h"

namespace saccade {

/// Records the events into the log, from where an interrupted program left off, and writes them
/// from there. The bytes do not depend on interruptions.
EventStatistics record_events(const CameraRecording& recording);

}  // namespace saccade
