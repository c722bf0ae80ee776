#include "core/io/ros/event_packet.h"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "core/io/events/prophesee/evt3_decoder.h"

namespace saccade {
namespace {

constexpr std::uint64_t kMostTimeNs = std::uint64_t{1} << 62U;

Event event_of(std::uint64_t t_ns, unsigned x, unsigned y, bool on) {
  return {static_cast<TimeNs>(t_ns), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
          static_cast<std::int8_t>(on ? 1 : -1)};
}

using PacketBytes = std::span<const std::byte>;

void expect_words(PacketBytes bytes, std::size_t size, const MessageReader& reader) {
  if (bytes.size() % size != 0)
    reader.fail(fmt::format("its {} bytes of events are no words of {} bytes", bytes.size(), size));
}

void decode_mono(const EventPacketHead& head, PacketBytes bytes, Events& events) {
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    const auto word = load<std::uint64_t>(bytes.data() + i);
    events.push_back(event_of(head.time_base + (word & 0xFFFFFFFFU),
                              static_cast<unsigned>(word >> 32U) & 0xFFFFU,
                              static_cast<unsigned>(word >> 48U) & 0x7FFFU, (word >> 63U) != 0));
  }
}

/// Events as libcaer has them in memory: valid (bit 0), polarity (1), row (2-16) and column (17-31),
/// and 31 bits of time [us], which may wrap within a packet.
void decode_libcaer(const EventPacketHead& head, PacketBytes bytes, Events& events) {
  std::uint64_t base_ns = head.time_base;
  std::uint32_t last_us = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    const auto data = load<std::uint32_t>(bytes.data() + i);
    const std::uint32_t t_us = load<std::uint32_t>(bytes.data() + i + 4) & 0x7FFFFFFFU;
    if (t_us < last_us) base_ns += (std::uint64_t{1} << 31U) * 1000;
    last_us = t_us;
    events.push_back(event_of(base_ns + std::uint64_t{t_us} * 1000, data >> 17U,
                              (data >> 2U) & 0x7FFFU, (data & 2U) != 0));
  }
}

/// Words of 16 bits, the upper 4 of which say what the others are.
void decode_libcaer_cmp(const EventPacketHead& head, PacketBytes bytes, const MessageReader& reader,
                        Events& events) {
  enum class Word { kTimeHigh, kTimeLow, kColumn, kRow, kVectorBase, kVector8 };
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  unsigned x = 0;
  unsigned base_y = 0;
  bool vector_on = false;
  const auto t_ns = [&] { return ((high << 12U | low) + head.time_base) * 1000; };
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const auto word = load<std::uint16_t>(bytes.data() + i);
    const unsigned value = word & 0xFFFU;
    const unsigned position = word & 0x7FFU;
    const bool on = (word & 0x800U) != 0;
    switch (static_cast<Word>(word >> 12U)) {
      case Word::kTimeHigh:
        high = value;
        break;
      case Word::kTimeLow:
        low = value;
        break;
      case Word::kColumn:
        x = position;
        break;
      case Word::kRow:
        events.push_back(event_of(t_ns(), x, position, on));
        break;
      case Word::kVectorBase:
        base_y = position;
        vector_on = on;
        break;
      case Word::kVector8:
        for (unsigned mask = value & 0xFFU; mask != 0; mask &= mask - 1)
          events.push_back(event_of(
              t_ns(), x, base_y + static_cast<unsigned>(std::countr_zero(mask)), vector_on));
        base_y += 8;
        break;
      default:
        reader.fail(fmt::format("word {} ({:04x}) is of a type that libcaer_cmp does not have",
                                i / 2, word));
    }
  }
}

}  // namespace

struct EventPacketDecoder::State {
  std::optional<Evt3Decoder> evt3;
  std::vector<Event> decoded;
  std::optional<TimeNs> shift_ns;  ///< from the sensor's clock to that of the messages

  void decode_evt3(PacketBytes bytes, SensorSize size, const MessageReader& reader, Events& events);
  void shift(const EventPacketHead& head, std::span<Event> events);
};

EventPacketDecoder::EventPacketDecoder() : state_(std::make_unique<State>()) {}
EventPacketDecoder::~EventPacketDecoder() = default;

void EventPacketDecoder::State::decode_evt3(PacketBytes bytes, SensorSize size,
                                            const MessageReader& reader, Events& events) {
  constexpr std::size_t kWordBytes = sizeof(Evt3Decoder::Word);
  if (!evt3)
    evt3.emplace(RawHeader{},
                 RawLimits{static_cast<unsigned>(size.width), static_cast<unsigned>(size.height)});
  constexpr std::size_t kBlockWords = std::size_t{1} << 12U;
  decoded.resize(kBlockWords * Evt3Decoder::kMostEvents);
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t count = std::min(kBlockWords, (bytes.size() - i) / kWordBytes);
    try {
      const Event* end = evt3->decode(bytes.data() + i, count, decoded.data());
      events.insert(events.end(), static_cast<const Event*>(decoded.data()), end);
    } catch (const RawError& error) {
      reader.fail(fmt::format("word {}: {}", i / kWordBytes + error.word, error.problem));
    }
    i += count * kWordBytes;
  }
}

void EventPacketDecoder::State::shift(const EventPacketHead& head, std::span<Event> events) {
  if (events.empty()) return;
  if (!shift_ns) shift_ns = head.stamp_ns - events.front().t_ns;
  for (Event& event : events) event.t_ns += *shift_ns;
}

EventPacketHead EventPacketDecoder::read_head(MessageReader& reader) {
  EventPacketHead head;
  head.stamp_ns = reader.header();
  head.height = reader.number<std::uint32_t>();
  head.width = reader.number<std::uint32_t>();
  static_cast<void>(reader.number<std::uint64_t>());  // a count
  head.time_base = reader.number<std::uint64_t>();
  head.encoding = reader.text();
  if (reader.flag()) reader.fail("its events are big-endian; little-endian ones can be read");
  if (head.time_base > kMostTimeNs)
    reader.fail(fmt::format("its time_base {} is too large", head.time_base));
  return head;
}

void EventPacketDecoder::decode(const EventPacketHead& head, MessageReader& reader, SensorSize size,
                                Events& events) {
  const PacketBytes bytes = reader.byte_array();
  const std::size_t before = events.size();
  if (head.encoding == "evt3") {
    expect_words(bytes, 2, reader);
    state_->decode_evt3(bytes, size, reader, events);
  } else if (head.encoding == "mono") {
    expect_words(bytes, 8, reader);
    decode_mono(head, bytes, events);
  } else if (head.encoding == "libcaer") {
    expect_words(bytes, 8, reader);
    decode_libcaer(head, bytes, events);
  } else if (head.encoding == "libcaer_cmp") {
    expect_words(bytes, 2, reader);
    if (head.time_base > kMostTimeNs / 1000)
      reader.fail(fmt::format("its time_base {} is too large", head.time_base));
    decode_libcaer_cmp(head, bytes, reader, events);
  } else {
    reader.fail(
        fmt::format("the encoding '{}' cannot be read; evt3, libcaer_cmp, libcaer and mono "
                    "can",
                    head.encoding));
  }
  if (head.encoding == "evt3" || head.encoding == "mono")
    state_->shift(head, std::span(events).subspan(before));
}

}  // namespace saccade
