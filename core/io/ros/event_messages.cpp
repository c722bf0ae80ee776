#include "core/io/ros/event_messages.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/io/events/rounded_events.h"
#include "core/io/ros/written_messages.h"

namespace saccade {
namespace {

constexpr TimeNs kMessageNs = 10'000'000;
constexpr std::size_t kMostMessageEvents = std::size_t{1} << 16U;

class MessageEventWriter final : public EventWriter {
 public:
  MessageEventWriter(const std::filesystem::path& file, TimestampUnit unit, SensorSize sensor)
      : writer_(make_message_writer(file)),
        messages_(*writer_, sensor, file.string()),
        rounded_(unit) {}

  void append(std::span<const Event> events) override {
    while (!events.empty()) {
      const std::span<const Event> part = events.first(std::min(events.size(), kEventBlock));
      events = events.subspan(part.size());
      rounded_.add(part);
      write_complete();
    }
  }

  void close() override {
    rounded_.finish();
    write_complete();
    messages_.flush();
    writer_->close();
  }

  [[nodiscard]] std::uint64_t count() const override { return messages_.count() + rounded_.size(); }

 private:
  void write_complete() {
    while (!rounded_.complete().empty()) {
      const std::span<const Event> events = rounded_.complete();
      messages_.append(events);
      rounded_.drop(events.size());
    }
  }

  std::unique_ptr<MessageFileWriter> writer_;
  EventMessages messages_;
  RoundedEvents rounded_;
};

}  // namespace

EventMessages::EventMessages(MessageFileWriter& writer, SensorSize sensor, std::string file)
    : writer_(writer), sensor_(sensor), file_(std::move(file)) {
  topic_ = writer_.add_topic(kWrittenEvents, writer_.serialisation() == Serialisation::kRos1
                                                 ? "dvs_msgs/EventArray"
                                                 : "event_camera_msgs/EventPacket");
}

void EventMessages::append(std::span<const Event> events) {
  constexpr int kMostRow = (1 << 15) - 1;
  for (const Event& event : events) {
    if (event.t_ns < 0)
      throw InputError(file_, fmt::format("ROS counts times from 0; there is an event at {:.9f} s",
                                          seconds_from_ns(event.t_ns)));
    if (event.y > kMostRow)
      throw InputError(file_, fmt::format("a packet holds rows up to {}; there is an event at ({}, "
                                          "{})",
                                          kMostRow, event.x, event.y));
    if (!held_.empty() &&
        (event.t_ns - held_.front().t_ns >= kMessageNs || held_.size() >= kMostMessageEvents))
      flush();
    held_.push_back(event);
  }
  count_ += events.size();
}

void EventMessages::flush() {
  if (held_.empty()) return;
  MessageBytes message(writer_.serialisation());
  if (message.is_cdr())
    put_event_packet(held_, sensor_, messages_, message);
  else
    put_event_array(held_, sensor_, message);
  ++messages_;
  writer_.write(topic_, held_.front().t_ns, message.bytes());
  held_.clear();
}

std::unique_ptr<EventWriter> make_message_event_writer(const std::filesystem::path& file,
                                                       TimestampUnit unit, SensorSize sensor) {
  return std::make_unique<MessageEventWriter>(file, unit, sensor);
}

}  // namespace saccade
