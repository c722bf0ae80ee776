#pragma once

#include "core/event.h"

namespace saccade {

/// A signal at a camera's input, or a mark of the camera itself.
struct Trigger {
  TimeNs t_ns = 0;
  int type = 0;  ///< by the numbers of AEDAT 4.0 (docs/formats.md)
};

}  // namespace saccade
