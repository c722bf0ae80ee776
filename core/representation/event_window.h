#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/config/fields.h"
#include "core/event.h"

namespace saccade {

/// How events are cut into windows, of which each becomes one grid; all in one unless stated.
struct WindowOptions {
  double duration_s = 0;   ///< > 0: [k, k + 1) * duration_s
  int events = 0;          ///< > 0: as many events, fewer in the last one
  bool by_frames = false;  ///< from each frame of the dataset to the next
};

void describe_windows(config::Fields& fields, WindowOptions& options);

/// Events `first` <= i < `last`, all within [from_ns, to_ns]; the latter belongs to the next window
/// where that starts at it.
struct GridWindow {
  TimeNs from_ns = 0, to_ns = 0;
  std::size_t first = 0, last = 0;
};

/// Windows in order of time, also those without events between others. `frames`: the times of the
/// frames, for by_frames. None without events.
[[nodiscard]] std::vector<GridWindow> cut_windows(std::span<const Event> events,
                                                  const WindowOptions& options,
                                                  std::span<const TimeNs> frames = {});

}  // namespace saccade
