#include "core/io/ros/message_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "core/error.h"
#include "core/io/events/event_formats.h"
#include "core/io/ros/event_packet.h"

namespace saccade {
namespace {

bool holds_arrays(const MessageTopic& topic) {
  return topic.type == "dvs_msgs/EventArray" || topic.type == "prophesee_event_msgs/EventArray";
}

/// Under its present and its former name.
bool holds_packets(const MessageTopic& topic) {
  return topic.type == "event_camera_msgs/EventPacket" ||
         topic.type == "event_array_msgs/EventArray";
}

class MessageEventReader final : public EventReader {
 public:
  MessageEventReader(const std::filesystem::path& path, SensorSize size, TimeWindow window)
      : place_(event_file_place(path)),
        file_(open_message_file(place_.file)),
        size_(size),
        window_(window) {
    // Until the first message, which states the sensor.
    while (first_.empty() && read_message(first_)) {
    }
  }

  bool read(Events& events) override {
    if (!first_.empty()) {
      events.insert(events.end(), first_.begin(), first_.end());
      first_ = {};
      return true;
    }
    const std::size_t before = events.size();
    while (events.size() < before + kEventBlock && read_message(events)) {
      if (events.size() > before && events.back().t_ns < window_.start_ns) events.resize(before);
    }
    return events.size() > before;
  }

  [[nodiscard]] SensorSize sensor() const override { return sensor_; }
  [[nodiscard]] TimestampUnit unit() const override { return TimestampUnit::kNanoseconds; }
  [[nodiscard]] std::uint64_t expected_count() const override {
    return window_.is_everything() ? file_->size() / kEventBytes : 0;
  }

 private:
  static constexpr std::size_t kEventBytes = 13;  // column and row, seconds and ns, polarity

  /// Appends the events of the next message of the topic; false where there is none.
  bool read_message(Events& events) {
    while (const auto message = file_->next()) {
      if (!holds_events(*message->topic) || !is_chosen(message->topic->name)) continue;
      append(*message, events);
      return true;
    }
    if (topic_.empty()) expect_topic();
    return false;
  }

  /// A topic without a message holds no events; a file without the topic is another one than meant.
  void expect_topic() const {
    for (const MessageTopic* topic : file_->topics())
      if (holds_events(*topic) && (place_.member.empty() || topic->name == place_.member)) return;
    throw InputError(place_.file.string(), place_.member.empty()
                                               ? "holds no events; " + topics_text()
                                               : fmt::format("holds no events of the topic {}; {}",
                                                             place_.member, topics_text()));
  }

  bool is_chosen(const std::string& topic) {
    if (!place_.member.empty() && topic != place_.member) return false;
    if (topic_.empty()) topic_ = topic;
    if (topic == topic_) return true;
    throw InputError(place_.file.string(),
                     fmt::format("holds events of several topics, {0} and {1}; name one, as in "
                                 "{2}!{0}",
                                 topic_, topic, place_.file.string()));
  }

  [[nodiscard]] std::string topics_text() const {
    std::set<std::string> names;
    for (const MessageTopic* topic : file_->topics())
      names.insert(fmt::format("{} ({})", topic->name, topic->type));
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "it has no topics" : "its topics are " + text;
  }

  void append(const Message& message, Events& events) {
    MessageReader reader(*file_, message);
    const std::size_t before = events.size();
    if (holds_arrays(*message.topic))
      append_array(reader, events);
    else
      append_packet(reader, events);
    for (std::size_t i = before; i < events.size(); ++i) check(events[i], i - before, reader);
  }

  void append_packet(MessageReader& reader, Events& events) {
    const EventPacketHead head = EventPacketDecoder::read_head(reader);
    take_sensor(head.width, head.height);
    packets_.decode(head, reader, size_, events);
  }

  void append_array(MessageReader& reader, Events& events) {
    static_cast<void>(reader.header());
    const auto height = reader.number<std::uint32_t>();
    const auto width = reader.number<std::uint32_t>();
    take_sensor(width, height);
    const std::uint64_t count = reader.number<std::uint32_t>();
    if (reader.is_cdr()) return append_aligned(reader, count, events);
    const auto bytes = reader.take(static_cast<std::size_t>(count) * kEventBytes);
    for (std::size_t i = 0; i < count; ++i) {
      const std::byte* at = bytes.data() + i * kEventBytes;
      Event event;
      event.x = load<std::uint16_t>(at);
      event.y = load<std::uint16_t>(at + 2);
      event.t_ns =
          TimeNs{load<std::uint32_t>(at + 4)} * 1'000'000'000 + load<std::uint32_t>(at + 8);
      event.polarity = at[12] != std::byte{0} ? 1 : -1;
      events.push_back(event);
    }
  }

  static void append_aligned(MessageReader& reader, std::uint64_t count, Events& events) {
    for (std::uint64_t i = 0; i < count; ++i) {
      Event event;
      event.x = reader.number<std::uint16_t>();
      event.y = reader.number<std::uint16_t>();
      event.t_ns = reader.time();
      event.polarity = reader.flag() ? 1 : -1;
      events.push_back(event);
    }
  }

  void check(const Event& event, std::size_t index, const MessageReader& reader) {
    if (event.x >= size_.width || event.y >= size_.height) [[unlikely]]
      reader.fail(fmt::format("event {}: pixel ({}, {}) lies outside the sensor of {} x {} px",
                              index, event.x, event.y, size_.width, size_.height));
    if (event.t_ns < last_ns_) [[unlikely]]
      reader.fail(fmt::format("event {}: time goes back: {:.9f} s after {:.9f} s", index,
                              seconds_from_ns(event.t_ns), seconds_from_ns(last_ns_)));
    last_ns_ = event.t_ns;
  }

  void take_sensor(std::uint32_t width, std::uint32_t height) {
    constexpr std::uint32_t kMost = 65536;
    const bool is_known = width > 0 && height > 0 && width <= kMost && height <= kMost;
    if (sensor_.width == 0 && is_known)
      sensor_ = {static_cast<int>(width), static_cast<int>(height)};
    if (size_.width == 0) size_ = sensor_;
    if (size_.width == 0) size_ = {kMost, kMost};
  }

  EventFilePlace place_;
  std::unique_ptr<MessageFile> file_;
  SensorSize size_;
  TimeWindow window_;
  SensorSize sensor_;
  std::string topic_;
  TimeNs last_ns_ = std::numeric_limits<TimeNs>::min();
  Events first_;
  EventPacketDecoder packets_;
};

}  // namespace

bool holds_events(const MessageTopic& topic) { return holds_arrays(topic) || holds_packets(topic); }

std::unique_ptr<EventReader> open_message_events(const std::filesystem::path& file, SensorSize size,
                                                 TimeWindow window) {
  return std::make_unique<MessageEventReader>(file, size, window);
}

}  // namespace saccade
