#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/event.h"
#include "core/io/events/event_file.h"
#include "core/io/ros/message_file.h"

namespace saccade {

/// What an event_camera_msgs/EventPacket states around its events.
struct EventPacketHead {
  TimeNs stamp_ns = 0;
  std::uint32_t width = 0;   ///< [px]
  std::uint32_t height = 0;  ///< [px]
  std::uint64_t time_base = 0;
  std::string encoding;
};

/// Decodes the packets of one topic, event_camera_msgs/EventPacket, in the encodings evt3 (EVT 3.0
/// of Prophesee), libcaer_cmp and libcaer (iniVation) and mono (u64: time since `time_base` [ns] in
/// 32 bits, column in 16, row in 15, polarity). libcaer's times count from 1970; those of evt3 and
/// mono are the sensor's, which are moved as a whole so that the first event has the stamp of its
/// message, on whose clock the other topics are.
class EventPacketDecoder {
 public:
  EventPacketDecoder();
  ~EventPacketDecoder();

  /// Reads the head, behind which the events of the packet are left.
  [[nodiscard]] static EventPacketHead read_head(MessageReader& reader);
  /// Appends the events behind the head. Fails for other encodings, events outside the sensor and
  /// words that the encoding does not have.
  void decode(const EventPacketHead& head, MessageReader& reader, SensorSize size, Events& events);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
