#include "core/io/events/tie_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/io/events/event_file.h"
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
  const std::size_t count = 3 * EventStream::kMostTies;
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
    EXPECT_LE(events.size(), 2 * EventStream::kMostTies);
    EXPECT_FALSE(EventOrder()(events.front(), last));
    EXPECT_TRUE(std::is_sorted(events.begin(), events.end(), EventOrder()));
    last = events.back();
    found += events.size();
  }
  EXPECT_EQ(found, count + 3);
  EXPECT_EQ(last, (Event{10000, 3, 3, -1}));
}

}  // namespace
}  // namespace saccade
