#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "core/io/events/event_file.h"
#include "core/io/ros/message_writer.h"

namespace saccade {

/// Where the events of a written recording are.
constexpr std::string_view kWrittenEvents = "/dvs/events";

/// Cuts a stream of events into messages of at most 10 ms, dvs_msgs/EventArray in ROS 1 and
/// event_camera_msgs/EventPacket in ROS 2. InputError for events before 1970 and rows that no packet
/// holds.
class EventMessages {
 public:
  /// Adds the topic to `writer`, which must live as long.
  EventMessages(MessageFileWriter& writer, SensorSize sensor, std::string file);

  /// `events` in order of time, not earlier than those before (contract).
  void append(std::span<const Event> events);
  /// Writes what is held back; messages that are written later should not be earlier.
  void flush();
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  MessageFileWriter& writer_;
  SensorSize sensor_;
  std::string file_;
  unsigned topic_ = 0;
  Events held_;
  std::uint64_t count_ = 0;
  std::uint64_t messages_ = 0;
};

/// Recordings that hold events alone.
[[nodiscard]] std::unique_ptr<EventWriter> make_message_event_writer(
    const std::filesystem::path& file, TimestampUnit unit, SensorSize sensor);

}  // namespace saccade
