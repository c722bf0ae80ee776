#include "simulator/event_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "core/random.h"
#include "simulator/recording_loop.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

/// What a sensor would deliver in the step from `begin` to `end` [ns], one event a nanosecond.
SensedEvents events_between(TimeNs begin, TimeNs end) {
  SensedEvents events;
  for (TimeNs t = begin; t < end; ++t) {
    const auto bits = Random(3).bits(0, static_cast<std::uint64_t>(t));
    events.push_back({t, static_cast<std::uint16_t>(bits[0]), static_cast<std::uint16_t>(bits[1]),
                      static_cast<std::int8_t>(bits[2] % 2 == 0 ? 1 : -1),
                      static_cast<EventOrigin>(bits[3] % 4)});
  }
  return events;
}

SensedEvents replayed(const EventLog& log) {
  SensedEvents events;
  log.replay([&](std::span<const SensedEvent> part) {
    events.insert(events.end(), part.begin(), part.end());
  });
  return events;
}

class Log : public ::testing::Test {
 protected:
  void corrupt(const std::string& name, std::streamoff position) const {
    std::fstream file(folder_ / name, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(position) << 'x';
    ASSERT_TRUE(file);
  }

  testing::TemporaryFolder parent_;
  const fs::path folder_ = parent_.path() / "cam0";
};

TEST_F(Log, IsNewAtFirst) {
  EventLog log(folder_);
  EXPECT_EQ(log.reached_s(), 0);
  EXPECT_EQ(log.take_state(), "");
  EXPECT_FALSE(log.statistics());
  EXPECT_TRUE(replayed(log).empty());
}

TEST_F(Log, GoesOnFromTheLastCheckpoint) {
  {
    EventLog log(folder_);
    log.append(events_between(0, 30'000));
    log.checkpoint(0.25, [] { return std::string("state at 30000"); });
    log.append(events_between(30'000, 70'000));  // found again by the next program
  }
  EventLog log(folder_);
  EXPECT_EQ(log.reached_s(), 0.25);
  EXPECT_EQ(log.take_state(), "state at 30000");
  EXPECT_EQ(replayed(log), events_between(0, 30'000));
  log.append(events_between(30'000, 90'000));
  log.complete({});
  EXPECT_EQ(replayed(log), events_between(0, 90'000));
}

TEST_F(Log, IsFollowedWhileItIsFilled) {
  EventLogTail tail(folder_);
  Events followed;
  tail.read(followed);
  EXPECT_TRUE(followed.empty());
  EventLog log(folder_);
  for (TimeNs at = 0; at < 60'000; at += 20'000) {
    log.append(events_between(at, at + 20'000));
    log.checkpoint(1e-9 * static_cast<double>(at), [] { return std::string("state"); });
    tail.read(followed);
    EXPECT_EQ(followed.size(), static_cast<std::size_t>(at) + 20'000);
  }
  Events expected;
  for (const SensedEvent& event : replayed(log)) expected.push_back(event.event());
  EXPECT_EQ(followed, expected);
}

TEST_F(Log, KnowsThatItIsComplete) {
  EventStatistics statistics;
  statistics.rays = 12345;
  statistics.time_bound_s = 1e-7;
  {
    EventLog log(folder_);
    log.append(events_between(0, 10));
    log.complete(statistics);
  }
  const EventLog log(folder_);
  ASSERT_TRUE(log.statistics());
  EXPECT_EQ(log.statistics()->rays, 12345U);
  EXPECT_EQ(log.statistics()->time_bound_s, 1e-7);
  EXPECT_EQ(replayed(log), events_between(0, 10));
}

TEST_F(Log, RefusesWhatIsDamaged) {
  const auto write = [&] {
    EventLog log(folder_);
    log.append(events_between(0, 1000));
    log.checkpoint(0.5, [] { return std::string("a state of the camera"); });
  };
  const auto open = [&] { return EventLog(folder_).reached_s(); };
  write();
  corrupt("events.journal", 5000);
  EXPECT_THAT(error_of(open), HasSubstr("events.journal: is damaged at byte 0"));
  fs::remove_all(folder_);
  write();
  corrupt("checkpoint", 50);
  EXPECT_THAT(error_of(open), HasSubstr("checkpoint: is damaged"));
  fs::remove_all(folder_);
  write();
  fs::resize_file(folder_ / "events.journal", 1000);
  EXPECT_THAT(error_of(open), HasSubstr("events.journal: is shorter than it was"));
  fs::resize_file(folder_ / "checkpoint", 3);
  EXPECT_THAT(error_of(open), HasSubstr("checkpoint: is damaged"));
}

/// Delivers the events above in steps, and is killed after some of them.
class FakeCamera {
 public:
  struct Killed {};
  explicit FakeCamera(int deliveries) : deliveries_(deliveries) {}

  void resume(const std::string& state) {
    reached_ = std::stoll(state);
    resumed_ = true;
  }
  [[nodiscard]] std::string state() const { return std::to_string(reached_); }
  [[nodiscard]] bool resumed() const { return resumed_; }
  [[nodiscard]] EventStatistics statistics() const { return {}; }

  template <class Sink>
  void record(double duration_s, const Sink& sink) {
    constexpr TimeNs kStep = 7919;
    const TimeNs end = ns_from_seconds(duration_s);
    while (reached_ < end) {
      if (deliveries_-- == 0) throw Killed();
      const TimeNs begin = reached_;
      reached_ = std::min(end, begin + kStep);
      sink(std::span<const SensedEvent>(events_between(begin, reached_)),
           seconds_from_ns(reached_));
    }
  }

 private:
  int deliveries_;
  TimeNs reached_ = 0;
  bool resumed_ = false;
};

TEST_F(Log, HoldsTheSameEventsHoweverOftenTheRecordingIsKilled) {
  constexpr double kDuration_s = 1e-4;
  int programs = 0;
  for (bool complete = false; !complete; ++programs) {
    ASSERT_LT(programs, 100);
    EventLog log(folder_, std::chrono::milliseconds(0), 0);
    FakeCamera camera(2);
    double shown_s = 0;
    try {
      record_into(log, camera, kDuration_s, [&](double t_s) { shown_s = t_s; });
      complete = true;
      EXPECT_EQ(shown_s, kDuration_s);
      EXPECT_EQ(replayed(log), events_between(0, 100'000));
    } catch (const FakeCamera::Killed&) {
    }
    EXPECT_EQ(camera.resumed(), programs > 0);
  }
  EXPECT_GT(programs, 5);
  EXPECT_EQ(replayed(EventLog(folder_)), events_between(0, 100'000));
}

}  // namespace
}  // namespace saccade
