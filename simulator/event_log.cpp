#include "simulator/event_log.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/file_bytes.h"

namespace saccade {
namespace {

constexpr std::uint64_t kMagic = 0x33474f4c44434153;  // of this layout

/// An event in the journal.
struct Packed {
  TimeNs t_ns;
  std::uint16_t x, y;
  std::int8_t polarity;
  std::uint8_t origin;
  std::uint16_t unused;
};
static_assert(sizeof(Packed) == 16);
static_assert(std::is_trivially_copyable_v<EventStatistics> &&
              std::is_trivially_copyable_v<AuditResult>);

constexpr const char* kJournalName = "events.journal";

template <class Use>
void for_each_packed(std::span<const std::byte> bytes, const Use& use) {
  for (std::size_t at = 0; at + sizeof(Packed) <= bytes.size(); at += sizeof(Packed)) {
    Packed packed;
    std::memcpy(&packed, bytes.data() + at, sizeof packed);
    use(packed);
  }
}

std::uint64_t checksum_of(std::string_view bytes) {
  return crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

}  // namespace

EventLog::EventLog(const std::filesystem::path& folder, std::chrono::milliseconds shortest_interval,
                   int time_divisor)
    : folder_(folder), shortest_interval_(shortest_interval), time_divisor_(time_divisor) {
  std::filesystem::create_directories(folder);
  if (std::filesystem::exists(folder / "checkpoint")) read_checkpoint();
  journal_.emplace(folder / kJournalName, head_.journal_length);
  journal_->read([](std::span<const std::byte>) {});  // whether it is damaged
  next_ = Clock::now() + shortest_interval_;
}

void EventLog::read_checkpoint() {
  const std::filesystem::path file = folder_ / "checkpoint";
  const std::vector<std::byte> bytes = read_file_bytes(file);
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.size() < sizeof head_) throw InputError(file.string(), "is damaged");
  std::memcpy(&head_, text.data(), sizeof head_);
  if (head_.magic != kMagic || head_.checksum != checksum_of(std::string_view(text).substr(16)))
    throw InputError(file.string(), "is damaged");
  text.erase(0, sizeof head_);
  if (head_.is_complete == 0) {
    state_ = std::move(text);
    return;
  }
  SACCADE_CHECK(text.size() == sizeof(EventStatistics) + sizeof(AuditResult));
  std::memcpy(&statistics_.emplace(), text.data(), sizeof(EventStatistics));
  std::memcpy(&audit_, text.data() + sizeof(EventStatistics), sizeof(AuditResult));
}

void EventLog::append(std::span<const SensedEvent> events) {
  packed_.resize(events.size() * sizeof(Packed));
  std::byte* out = packed_.data();
  for (const SensedEvent& event : events) {
    const Packed packed{
        event.t_ns, event.x, event.y, event.polarity, static_cast<std::uint8_t>(event.origin), 0};
    std::memcpy(out, &packed, sizeof packed);
    out += sizeof packed;
  }
  journal_->append(packed_);
}

bool EventLog::wants_checkpoint() const { return Clock::now() >= next_; }

void EventLog::checkpoint(double reached_s, const std::function<std::string()>& state) {
  const Clock::time_point start = Clock::now();
  head_.reached_s = reached_s;
  write_checkpoint(state());
  const Clock::time_point end = Clock::now();
  next_ = end + std::max<Clock::duration>(shortest_interval_, time_divisor_ * (end - start));
}

void EventLog::complete(const EventStatistics& statistics, const AuditResult& audit) {
  head_.is_complete = 1;
  statistics_ = statistics;
  audit_ = audit;
  std::string payload(reinterpret_cast<const char*>(&statistics), sizeof statistics);
  payload.append(reinterpret_cast<const char*>(&audit), sizeof audit);
  write_checkpoint(payload);
}

void EventLog::write_checkpoint(std::string_view payload) {
  journal_->flush();
  head_.magic = kMagic;
  head_.journal_length = journal_->length();
  std::string text(sizeof head_, '\0');
  text += payload;
  std::memcpy(text.data(), &head_, sizeof head_);
  head_.checksum = checksum_of(std::string_view(text).substr(16));
  std::memcpy(text.data(), &head_, sizeof head_);
  write_atomically(folder_ / "checkpoint", text);
}

void EventLog::replay(const std::function<void(std::span<const SensedEvent>)>& use) const {
  std::vector<SensedEvent> events;
  journal_->read([&](std::span<const std::byte> bytes) {
    events.clear();
    for_each_packed(bytes, [&](const Packed& packed) {
      SensedEvent& event = events.emplace_back();
      event.t_ns = packed.t_ns;
      event.x = packed.x;
      event.y = packed.y;
      event.polarity = packed.polarity;
      event.origin = static_cast<EventOrigin>(packed.origin);
    });
    use(events);
  });
}

EventLogTail::EventLogTail(const std::filesystem::path& folder) : journal_(folder / kJournalName) {}

void EventLogTail::read(Events& events) {
  journal_.read([&](std::span<const std::byte> bytes) {
    for_each_packed(bytes, [&](const Packed& packed) {
      events.push_back({packed.t_ns, packed.x, packed.y, packed.polarity});
    });
  });
}

}  // namespace saccade
