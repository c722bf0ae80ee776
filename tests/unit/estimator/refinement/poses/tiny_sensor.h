#pragma once

#include "core/camera.h"
#include "core/event.h"

namespace saccade::testing {

/// Four pixels by three, a focal length of four.
inline PinholeCamera tiny_camera() {
  PinholeCamera camera;
  camera.width = 4;
  camera.height = 3;
  camera.fx = camera.fy = 4;
  camera.cx = 1.5;
  camera.cy = 1;
  return camera;
}

/// Pixel (1, 2) goes up and then down, a millisecond after another from the first on.
inline Events ups_and_downs(int ups, int downs) {
  Events events;
  for (int i = 0; i < ups + downs; ++i)
    events.push_back({1000000LL * (i + 1), 1, 2, static_cast<std::int8_t>(i < ups ? 1 : -1)});
  return events;
}

}  // namespace saccade::testing
