#pragma once

#include <span>

#include "core/event.h"

namespace saccade {

/// Mean time of the events [ns], which stamps the pose of their frame; at least one event.
[[nodiscard]] TimeNs mean_time(std::span<const Event> events);

}  // namespace saccade
