#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/files/block_journal.h"
#include "simulator/sensor/adaptive/audit_result.h"
#include "simulator/sensor/event_tile.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// The events of a recording in the making, with what the event camera needs to go on from there,
/// in a folder that outlives an interrupted program: `events.journal`, 16 bytes an event in blocks
/// with checksums, and `checkpoint`, the camera's state at an instant with the journal's length
/// then. What the journal holds beyond that length is found again, so the final events do not
/// depend on when checkpoints were taken.
class EventLog {
 public:
  /// Goes on with what `folder` holds, which is created when it is not there. InputError when that
  /// is damaged. `shortest_interval`: from one checkpoint to the next; saving takes at most
  /// 1 / `time_divisor` of the time.
  explicit EventLog(const std::filesystem::path& folder,
                    std::chrono::milliseconds shortest_interval = std::chrono::milliseconds(500),
                    int time_divisor = 20);

  /// Time up to which the log holds all events that the state stands for [s]; 0 for a new one.
  [[nodiscard]] double reached_s() const { return head_.reached_s; }
  /// The camera's state at reached_s(), once; empty for a new log.
  [[nodiscard]] std::string take_state() { return std::move(state_); }
  /// Of a log that holds the whole recording.
  [[nodiscard]] const std::optional<EventStatistics>& statistics() const { return statistics_; }
  /// Of such a log; without pixels where nothing was audited.
  [[nodiscard]] const AuditResult& audit() const { return audit_; }

  /// Events in order.
  void append(std::span<const SensedEvent> events);
  /// True when so much time has passed since the last checkpoint that one costs little of it.
  [[nodiscard]] bool wants_checkpoint() const;
  /// Everything up to `reached_s` is appended, and what `state` returns goes on from there. It is
  /// called here, so that the time it takes counts.
  void checkpoint(double reached_s, const std::function<std::string()>& state);
  /// The recording is complete.
  void complete(const EventStatistics& statistics, const AuditResult& audit = {});

  /// Hands out all events up to the last checkpoint, in order, in parts.
  void replay(const std::function<void(std::span<const SensedEvent>)>& use) const;

 private:
  using Clock = std::chrono::steady_clock;
  /// The first bytes of the checkpoint file; the state or the statistics follow.
  struct Head {
    std::uint64_t magic = 0;
    std::uint64_t checksum = 0;        ///< of all that follows it
    std::uint64_t journal_length = 0;  ///< [bytes]
    double reached_s = 0;
    std::uint64_t is_complete = 0;
  };

  void read_checkpoint();
  void write_checkpoint(std::string_view payload);

  std::filesystem::path folder_;
  std::chrono::milliseconds shortest_interval_;
  int time_divisor_;
  Head head_;
  std::string state_;
  std::optional<EventStatistics> statistics_;
  AuditResult audit_;
  std::optional<BlockJournal> journal_;
  std::vector<std::byte> packed_;
  Clock::time_point next_;
};

/// The events of a log that another program is filling, as they come. The log is not changed.
class EventLogTail {
 public:
  /// `folder`: of the log; need not be there yet.
  explicit EventLogTail(const std::filesystem::path& folder);
  /// Appends the events that came since the last call; those of a recording that began anew come
  /// anew.
  void read(Events& events);

 private:
  BlockJournalTail journal_;
};

}  // namespace saccade
