#include "estimator/tracking/edges/event_window.h"

#include <gtest/gtest.h>

#include "estimator/mean_time.h"

namespace saccade {
namespace {

Events stream_of(int count) {
  constexpr TimeNs kStart = 1'700'000'000'000'000'000;  // nanoseconds since 1970
  Events events;
  for (int i = 0; i < count; ++i)
    events.push_back({kStart + 7 * i * i, static_cast<std::uint16_t>(i % 60),
                      static_cast<std::uint16_t>(i % 40), 1});
  return events;
}

EventFrameOptions sliding(double step) {
  EventFrameOptions options;
  options.window = EventFrameOptions::Window::kSliding;
  options.new_fraction = step;
  return options;
}

TEST(EventWindow, DisjointFramesTakeOneRunAfterAnother) {
  const Events stream = stream_of(100);
  EventWindow window({});
  window.start(stream);
  std::size_t begin = 0;
  for (const std::size_t count : {30U, 20U, 40U}) {
    ASSERT_TRUE(window.advance(count));
    EXPECT_EQ(window.events().data(), stream.data() + begin);
    EXPECT_EQ(window.events().size(), count);
    EXPECT_EQ(window.entered().size(), count);
    EXPECT_EQ(window.new_fraction(), 1);
    EXPECT_EQ(window.mean_time(), mean_time(window.events()));
    begin += count;
  }
  EXPECT_FALSE(window.advance(11));
  EXPECT_EQ(window.events().size(), 40U) << "stays where it was";
  EXPECT_TRUE(window.advance(10));
}

TEST(EventWindow, TheNewestEventsReachBackBeyondTheFrame) {
  const Events stream = stream_of(100);
  EventWindow window({});
  window.start(stream);
  ASSERT_TRUE(window.advance(30));
  ASSERT_TRUE(window.advance(20));
  EXPECT_EQ(window.newest(35).data(), stream.data() + 15);
  EXPECT_EQ(window.newest(35).size(), 35U);
  EXPECT_EQ(window.newest(80).size(), 50U) << "as many as there are";
  EXPECT_EQ(window.events().size(), 20U) << "the frame stays";
}

TEST(EventWindow, SlidingFramesHoldTheNewestEvents) {
  const Events stream = stream_of(100);
  EventWindow window(sliding(0.25));
  window.start(stream);
  ASSERT_TRUE(window.advance(40));
  EXPECT_EQ(window.new_fraction(), 1);
  for (std::size_t end = 50; end <= 100; end += 10) {
    ASSERT_TRUE(window.advance(40));
    EXPECT_EQ(window.events().data() + 40, stream.data() + end);
    EXPECT_EQ(window.events().size(), 40U);
    EXPECT_EQ(window.entered().size(), 10U);
    EXPECT_EQ(window.left().size(), 10U);
    EXPECT_EQ(window.new_fraction(), 0.25);
    EXPECT_NEAR(static_cast<double>(window.mean_time() - mean_time(window.events())), 0, 1);
  }
  EXPECT_FALSE(window.advance(40));
}

TEST(EventWindow, FollowsACountThatChanges) {
  const Events stream = stream_of(3000);
  EventWindow window(sliding(0.1));
  window.start(stream);
  std::size_t count = 200;
  ASSERT_TRUE(window.advance(count));
  std::size_t begin = 0;
  std::size_t end = count;
  for (int i = 0; i < 40; ++i) {
    count = i < 20 ? count + 15 : count - 12;
    ASSERT_TRUE(window.advance(count));
    EXPECT_EQ(window.entered().data(), stream.data() + end);
    EXPECT_EQ(window.left().data(), stream.data() + begin);
    begin += window.left().size();
    end += window.entered().size();
    EXPECT_EQ(window.events().data(), stream.data() + begin);
    EXPECT_EQ(window.events().size(), end - begin);
    EXPECT_LE(window.events().size(), count);
  }
  EXPECT_EQ(window.events().size(), count) << "a shrinking count is met at once";
}

TEST(EventWindow, AFrameAlwaysMovesOn) {
  const Events stream = stream_of(10);
  EventWindow window(sliding(0.01));
  window.start(stream);
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(window.advance(3));
  EXPECT_FALSE(window.advance(3));
}

TEST(EventWindow, AStepOfOneIsDisjoint) {
  const Events stream = stream_of(100);
  EventWindow window(sliding(1));
  window.start(stream);
  ASSERT_TRUE(window.advance(30));
  ASSERT_TRUE(window.advance(30));
  EXPECT_EQ(window.events().data(), stream.data() + 30);
  EXPECT_EQ(window.left().size(), 30U);
}

}  // namespace
}  // namespace saccade
