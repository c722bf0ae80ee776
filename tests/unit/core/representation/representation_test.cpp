#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/random.h"
#include "core/representation/event_frame.h"
#include "core/representation/voxel_grid.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;

constexpr SensorSize kSize{7, 5};

Events random_events(std::size_t count) {
  const Random random(1);
  Events events(count);
  for (std::size_t i = 0; i < count; ++i)
    events[i] = {static_cast<TimeNs>(1'000'000 * i + 100'000),
                 static_cast<std::uint16_t>(random.below(7, 0, i)),
                 static_cast<std::uint16_t>(random.below(5, 1, i)),
                 static_cast<std::int8_t>(random.below(2, 2, i) == 0 ? -1 : 1)};
  return events;
}

double sum(const EventGrid& grid, std::size_t first = 0, std::size_t count = 1'000'000) {
  const auto begin = grid.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(
      begin, begin + static_cast<std::ptrdiff_t>(std::min(count, grid.size() - first)), 0.0);
}

TEST(EventWindows, OfTimeBeginAtMultiplesAndHoldEveryEventOnce) {
  const Events events = random_events(103);
  const std::vector<GridWindow> windows = cut_windows(events, {0.01, 0, false});
  ASSERT_EQ(windows.size(), 11U);
  std::size_t next = 0;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    EXPECT_EQ(windows[k].from_ns, static_cast<TimeNs>(k) * 10'000'000);
    EXPECT_EQ(windows[k].first, next);
    next = windows[k].last;
  }
  EXPECT_EQ(next, events.size());
}

TEST(EventWindows, OfEventsOfFramesAndOfEverything) {
  const Events events = random_events(103);
  const std::vector<GridWindow> by_count = cut_windows(events, {0, 50, false});
  ASSERT_EQ(by_count.size(), 3U);
  EXPECT_EQ(by_count[2].last - by_count[2].first, 3U);
  EXPECT_EQ(by_count[1].from_ns, events[50].t_ns);
  EXPECT_EQ(by_count[1].to_ns, events[99].t_ns);
  // An event at a frame's time belongs to the window that begins with it.
  const std::vector<TimeNs> frames{0, 100'000, 50'100'000};
  const std::vector<GridWindow> by_frames = cut_windows(events, {0, 0, true}, frames);
  ASSERT_EQ(by_frames.size(), 2U);
  EXPECT_EQ(by_frames[0].last, 0U);
  EXPECT_EQ(by_frames[1].last, 50U);
  EXPECT_EQ(cut_windows(events, {}).at(0).last, 103U);
  EXPECT_TRUE(cut_windows({}, {0.01, 0, false}).empty());
}

TEST(VoxelGrid, AnEventIsDividedBetweenItsTwoBins) {
  const Events events{{0, 1, 2, 1}, {250, 3, 4, -1}, {1000, 6, 0, 1}};
  VoxelGridOptions options;
  options.bins = 3;
  const EventGrid grid = voxel_grid(events, {0, 1000, 0, 3}, kSize, options);
  const auto at = [&](int bin, int x, int y) {
    return grid[static_cast<std::size_t>((bin * 5 + y) * 7 + x)];
  };
  EXPECT_EQ(at(0, 1, 2), 1);
  EXPECT_FLOAT_EQ(at(0, 3, 4), -0.5F);  // 2 * 0.25 = 0.5 bins after the first
  EXPECT_FLOAT_EQ(at(1, 3, 4), -0.5F);
  EXPECT_EQ(at(2, 6, 0), 1);
  EXPECT_NEAR(sum(grid), 1, 1e-6);
}

TEST(VoxelGrid, SumsAreThoseOfThePolarities) {
  const Events events = random_events(1000);
  double on = 0;
  for (const Event& event : events) on += event.polarity > 0 ? 1 : 0;
  for (const int bins : {1, 2, 5, 16})
    for (const auto span : {VoxelGridOptions::Span::kEvents, VoxelGridOptions::Span::kWindow}) {
      VoxelGridOptions options;
      options.bins = bins;
      options.span = span;
      const GridWindow window{0, 2'000'000'000, 0, events.size()};
      EXPECT_NEAR(sum(voxel_grid(events, window, kSize, options)), on - (1000 - on), 1e-3);
      options.polarity = VoxelGridOptions::Polarity::kSeparate;
      const EventGrid grid = voxel_grid(events, window, kSize, options);
      ASSERT_EQ(grid.size(), static_cast<std::size_t>(2 * bins * 35));
      EXPECT_NEAR(sum(grid, 0, static_cast<std::size_t>(bins * 35)), on, 1e-3);
      EXPECT_NEAR(sum(grid, static_cast<std::size_t>(bins * 35)), 1000 - on, 1e-3);
    }
}

TEST(VoxelGrid, NormalisationLeavesZerosAndGivesTheOthersMeanZeroAndSigmaOne) {
  const Events events = random_events(40);
  VoxelGridOptions options;
  const GridWindow window{0, 40'000'000, 0, events.size()};
  const EventGrid raw = voxel_grid(events, window, kSize, options);
  options.normalize = VoxelGridOptions::Normalize::kNonzero;
  const EventGrid grid = voxel_grid(events, window, kSize, options);
  double count = 0, mean = 0, squares = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (raw[i] == 0) {
      EXPECT_EQ(grid[i], 0);
      continue;
    }
    ++count;
    mean += static_cast<double>(grid[i]);
    squares += static_cast<double>(grid[i]) * static_cast<double>(grid[i]);
  }
  EXPECT_NEAR(mean / count, 0, 1e-6);
  EXPECT_NEAR(squares / count, 1, 1e-5);
}

TEST(VoxelGrid, EventsOfOneTimeAndNoEventsAreFine) {
  const Events events{{500, 1, 1, 1}, {500, 2, 1, 1}};
  const EventGrid grid = voxel_grid(events, {500, 500, 0, 2}, kSize, {});
  EXPECT_EQ(sum(grid, 0, 35), 2);
  EXPECT_EQ(sum(voxel_grid({}, {0, 10, 0, 0}, kSize, {})), 0);
}

TEST(EventFrame, CountsOfEventsAndOfPolarities) {
  const Events events{{0, 1, 0, 1}, {1, 1, 0, 1}, {2, 1, 0, -1}, {3, 6, 4, -1}};
  const GridWindow window{0, 3, 0, 4};
  FrameGridOptions options;
  options.kind = FrameGridOptions::Kind::kCount;
  const EventGrid count = EventFrameMaker(kSize, options).next(events, window);
  ASSERT_EQ(count.size(), 35U);
  EXPECT_EQ(count[1], 3);
  EXPECT_EQ(count[34], 1);
  EXPECT_EQ(sum(count), 4);
  options.kind = FrameGridOptions::Kind::kPolarity;
  const EventGrid polarity = EventFrameMaker(kSize, options).next(events, window);
  ASSERT_EQ(polarity.size(), 70U);
  EXPECT_EQ(polarity[1], 2);
  EXPECT_EQ(polarity[35 + 1], 1);
  EXPECT_EQ(polarity[35 + 34], 1);
}

TEST(EventFrame, ATimeSurfaceRemembersEarlierWindows) {
  FrameGridOptions options;
  options.kind = FrameGridOptions::Kind::kTimeSurface;
  options.decay_s = 0.01;
  EventFrameMaker maker(kSize, options);
  const Events first{{0, 0, 0, 1}, {5'000'000, 1, 0, 1}};
  const Events second{{12'000'000, 1, 0, -1}, {15'000'000, 0, 0, 1}};
  const EventGrid a = maker.next(first, {0, 10'000'000, 0, 2});
  EXPECT_NEAR(a[0], std::exp(-1.0), 1e-6);
  EXPECT_NEAR(a[1], std::exp(-0.5), 1e-6);
  EXPECT_EQ(a[2], 0);
  const EventGrid b = maker.next(second, {10'000'000, 20'000'000, 2, 4});
  EXPECT_NEAR(b[0], std::exp(-0.5), 1e-6);
  EXPECT_NEAR(b[1], std::exp(-1.5), 1e-6);
  EXPECT_NEAR(b[35 + 1], std::exp(-0.8), 1e-6);
}

}  // namespace
}  // namespace saccade
