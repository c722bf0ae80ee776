#pragma once

#include <filesystem>
#include <memory>

#include "core/io/events/event_file.h"
#include "core/io/ros/bag_file.h"

namespace saccade {

/// Whether messages of events arrive there.
[[nodiscard]] bool holds_events(const BagTopic& topic);

/// The events of a bag: messages dvs_msgs/EventArray, or prophesee_event_msgs/EventArray, which
/// are the same, of one topic. Where there are several, "FILE!/topic" names it.
[[nodiscard]] std::unique_ptr<EventReader> open_bag_events(const std::filesystem::path& file,
                                                           SensorSize size, TimeWindow window);

}  // namespace saccade
