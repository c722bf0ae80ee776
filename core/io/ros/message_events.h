#pragma once

#include <filesystem>
#include <memory>

#include "core/io/events/event_file.h"
#include "core/io/ros/message_file.h"

namespace saccade {

/// Whether messages of events arrive there.
[[nodiscard]] bool holds_events(const MessageTopic& topic);

/// The events of a recording of ROS (message_file.h): messages dvs_msgs/EventArray,
/// prophesee_event_msgs/EventArray, which are the same, or event_camera_msgs/EventPacket
/// (event_packet.h), of one topic. Where there are several, "FILE!/topic" names it.
[[nodiscard]] std::unique_ptr<EventReader> open_message_events(const std::filesystem::path& file,
                                                               SensorSize size, TimeWindow window);

}  // namespace saccade
