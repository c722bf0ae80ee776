#include "core/io/events/tie_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/io/events/event_file.h"
#include "core/io/events/rounded_events.h"
#include "tests/support/command.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

TEST(TieRun, GivesTheEventsInOrderBlockByBlock) {
  Events events = testing::random_events(3000);
  for (Event& event : events) event.t_ns = 77;
  events.insert(events.end(), events.begin(), events.begin() + 500);  // some fire twice
  TieRun run;
  run.add(std::span(events).first(1000));
  run.add(std::span(events).subspan(1000));
  run.complete();
  Events taken;
  while (!run.empty()) {
    const std::size_t before = taken.size();
    run.take(64, taken);
    EXPECT_LE(taken.size() - before, 64U);
  }
  sort_ties(events);
  EXPECT_EQ(taken, events);
  // It may be used anew.
  run.add(std::span(events).first(1));
  run.complete();
  Events again;
  run.take(5, again);
  EXPECT_EQ(again, Events(events.begin(), events.begin() + 1));
}

/// A file whose events all have one time, between two others.
TEST(EventStream, RunsLongerThanMemoryAreCounted) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "e.h5";
  const auto writer = make_event_writer(file, TimestampUnit::kMicroseconds, {64, 48});
  const std::size_t count = 3 * TieRun::kMostHeld;
  Events block;
  for (std::size_t i = 0; i < (std::size_t{1} << 16U); ++i)
    block.push_back({5000, static_cast<std::uint16_t>((7 * i) % 64),
                     static_cast<std::uint16_t>((11 * i) % 48), 1});
  writer->append(Events{{1000, 1, 1, 1}});
  for (std::size_t written = 0; written < count; written += block.size()) writer->append(block);
  writer->append(Events{{9000, 2, 2, -1}, {10000, 3, 3, -1}});
  writer->close();
  EventStream stream(file, {64, 48});
  std::size_t found = 0;
  Event last{0, 0, 0, -1};
  for (auto events = stream.next(); !events.empty(); events = stream.next()) {
    EXPECT_LE(events.size(), 2 * TieRun::kMostHeld);
    EXPECT_FALSE(EventOrder()(events.front(), last));
    EXPECT_TRUE(std::is_sorted(events.begin(), events.end(), EventOrder()));
    last = events.back();
    found += events.size();
  }
  EXPECT_EQ(found, count + 3);
  EXPECT_EQ(last, (Event{10000, 3, 3, -1}));
}

/// Of more events than are held at one time, and some behind them.
TEST(RoundedEvents, RunsLongerThanMemoryAreGivenOutInParts) {
  RoundedEvents rounded(TimestampUnit::kMicroseconds);
  const std::size_t count = TieRun::kMostHeld + TieRun::kMostHeld / 2;
  Events block;
  for (std::size_t i = 0; i < (std::size_t{1} << 16U); ++i)
    block.push_back({5000 + static_cast<TimeNs>(i % 2), static_cast<std::uint16_t>((7 * i) % 64),
                     static_cast<std::uint16_t>((11 * i) % 48), 1});
  std::sort(block.begin(), block.end(),
            [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
  rounded.add(Events{{1000, 9, 9, 1}});
  std::size_t added = 0;
  for (; added < count; added += block.size()) {
    for (Event& event : block) event.t_ns = 5000 + (added > count / 2 ? 300 : 0);
    rounded.add(block);
    EXPECT_LE(rounded.complete().size(), 1U);
  }
  rounded.add(Events{{9000, 2, 2, -1}, {9000, 1, 1, -1}, {12'000, 3, 3, 1}});
  rounded.finish();
  EXPECT_EQ(rounded.size(), added + 4);
  Events all;
  while (!rounded.complete().empty()) {
    const auto part = rounded.complete();
    EXPECT_LE(part.size(), 2 * RoundedEvents::kLeast);
    all.insert(all.end(), part.begin(), part.end());
    rounded.drop(part.size());
  }
  ASSERT_EQ(all.size(), added + 4);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), EventOrder()));
  EXPECT_EQ(all.front(), (Event{1000, 9, 9, 1}));
  EXPECT_EQ(all[all.size() - 3], (Event{9000, 1, 1, -1}));
  EXPECT_EQ(all.back(), (Event{12'000, 3, 3, 1}));
}

}  // namespace
}  // namespace saccade
