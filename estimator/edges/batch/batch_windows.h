#pragma once

#include <span>
#include <vector>

#include "core/event.h"

namespace saccade {

/// The events that a keyframe's edges are sought in.
[[nodiscard]] std::span<const Event> events_of_view(std::span<const Event> events, double t_s,
                                                    double window_s);

/// The keyframes' times, in order and at least one, and more between them and behind the last, so
/// that a view is never farther than a third of a window from the next and from the end: where no
/// window reaches, nothing constrains the path.
[[nodiscard]] std::vector<double> batch_views(std::vector<double> keyframe_s, double end_s,
                                              double window_s);

}  // namespace saccade
