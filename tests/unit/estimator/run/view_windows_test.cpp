#include "estimator/run/view_windows.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

using Reference = ViewWindowOptions::Reference;

Trajectory still(double start_s, double end_s) { return Trajectory({{start_s, {}}, {end_s, {}}}); }

/// `count` events, `step_ns` apart.
Events stream(int count, TimeNs step_ns) {
  Events events;
  for (int i = 0; i < count; ++i) events.push_back({i * step_ns, 0, 0, 1});
  return events;
}

TEST(ViewWindows, HoldAllEventsOnceAndAreEven) {
  const Events events = stream(1001, 1'000'000);  // 1 s
  const Trajectory trajectory = still(0, 1);
  for (const auto& options :
       {ViewWindowOptions{.duration_s = 0.3, .events = {}}, ViewWindowOptions{.events = 300}}) {
    const auto windows = cut_windows(events, trajectory, options);
    ASSERT_EQ(windows.size(), 4U);
    const Event* next = events.data();
    for (const ViewWindow& window : windows) {
      EXPECT_EQ(window.events.data(), next);
      next += window.events.size();
      EXPECT_NEAR(static_cast<double>(window.events.size()), 250, 2);
    }
    EXPECT_EQ(next, events.data() + events.size());
  }
}

TEST(ViewWindows, TheViewLiesWhereItIsAskedFor) {
  const Events events = stream(101, 1'000'000);
  const Trajectory trajectory = still(0, 1);
  for (const auto& [reference, expected_s] :
       {std::pair{Reference::kStart, 0.0}, {Reference::kMiddle, 0.05}, {Reference::kEnd, 0.1}}) {
    const auto windows = cut_windows(events, trajectory, {.events = {}, .reference = reference});
    ASSERT_EQ(windows.size(), 1U);
    EXPECT_NEAR(windows[0].reference_s, expected_s, 1e-12);
  }
}

TEST(ViewWindows, TheViewLiesAtTheFrameNearestToTheMiddle) {
  const Events events = stream(101, 1'000'000);
  const Trajectory trajectory = still(0, 1);
  const auto view_at = [&](const std::vector<StampedFile>& frames) {
    return cut_windows(events, trajectory, {.events = {}, .reference = Reference::kFrame},
                       frames)[0]
        .reference_s;
  };
  EXPECT_EQ(view_at({{0.01, ""}, {0.04, ""}, {0.07, ""}, {0.2, ""}}), 0.04);
  // One outside of the window is no place for its view.
  EXPECT_NEAR(view_at({{0.11, ""}}), 0.05, 1e-12);
  EXPECT_NEAR(view_at({}), 0.05, 1e-12);
}

TEST(ViewWindows, AStillCameraHasNoWindow) {
  Events events = stream(10, 1'000'000);
  for (int i = 0; i < 10; ++i) events.push_back({1'000'000'000 + i, 0, 0, 1});
  const Trajectory trajectory = still(0, 2);
  EXPECT_EQ(cut_windows(events, trajectory, {.duration_s = 0.1, .events = {}}).size(), 2U);
  EXPECT_TRUE(cut_windows({}, trajectory, {}).empty());
}

TEST(ViewWindows, OnlyEventsWithPosesCount) {
  const Events events = stream(1001, 1'000'000);
  const auto inside = within(events, still(0.2, 0.6));
  ASSERT_EQ(inside.size(), 401U);
  EXPECT_EQ(inside.front().t_ns, 200'000'000);
  EXPECT_EQ(inside.back().t_ns, 600'000'000);
  EXPECT_TRUE(within(events, still(2, 3)).empty());
  EXPECT_TRUE(within(events, Trajectory{}).empty());
}

}  // namespace
}  // namespace saccade
