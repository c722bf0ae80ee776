#include "estimator/tracking/edges/event_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/mean_time.h"

namespace saccade {
namespace {

PinholeCamera lens_camera(double k1 = 0) {
  PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = camera.fy = 55;
  camera.cx = 31;
  camera.cy = 24;
  camera.distortion[0] = k1;
  return camera;
}

Event at(int x, int y, TimeNs t_ns = 0) {
  return {t_ns, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1};
}

int sum(const EventFrame& frame) {
  int total = 0;
  for (int y = 0; y < frame.height(); ++y)
    for (int x = 0; x < frame.width(); ++x) total += frame(x, y);
  return total;
}

TEST(EventFrame, IsFullWhereAnEventFellAndEmptyElsewhere) {
  EventFrame frame(lens_camera());
  frame.draw(Events{at(0, 0), at(30, 20), at(30, 20), at(63, 47)});
  EXPECT_EQ(frame(0, 0), EventFrame::kFull);
  EXPECT_EQ(frame(30, 20), EventFrame::kFull) << "twice is no more than once";
  EXPECT_EQ(frame(63, 47), EventFrame::kFull);
  EXPECT_EQ(sum(frame), 3 * EventFrame::kFull);
  frame.clear();
  EXPECT_EQ(sum(frame), 0);
}

TEST(EventFrame, PolarityIsIgnored) {
  EventFrame frame(lens_camera());
  Event off = at(7, 8);
  off.polarity = -1;
  frame.draw(std::span(&off, 1));
  EXPECT_EQ(frame(7, 8), EventFrame::kFull);
}

TEST(EventFrame, MovesEventsToTheUndistortedPixel) {
  const PinholeCamera lens = lens_camera(-0.25);
  int moved = 0;
  for (int y = 0; y < lens.height; y += 3)
    for (int x = 0; x < lens.width; x += 3) {
      const Eigen::Vector2d p = lens.undistort({x, y});
      const int px = static_cast<int>(std::lround(p.x()));
      const int py = static_cast<int>(std::lround(p.y()));
      const bool inside = px >= 0 && py >= 0 && px < lens.width && py < lens.height;
      EventFrame frame(lens);
      frame.draw(Events{at(x, y)});
      EXPECT_EQ(sum(frame), inside ? EventFrame::kFull : 0) << x << ' ' << y;
      if (inside) {
        EXPECT_EQ(frame(px, py), EventFrame::kFull) << x << ' ' << y;
      }
      moved += static_cast<int>(px != x || py != y);
    }
  EXPECT_GT(moved, 100) << "the lens must matter";
}

TEST(EventFrame, RemoveTakesBackWhatAddDrew) {
  Events events;
  for (int i = 0; i < 600; ++i) events.push_back(at(i * 7 % 64, i * 5 % 48));  // some pixels twice
  for (const double k1 : {0.0, -0.25}) {
    EventFrame sliding(lens_camera(k1));
    for (std::size_t begin = 0; begin + 300 <= events.size(); begin += 100) {
      if (begin > 0) sliding.remove(std::span(events).subspan(begin - 100, 100));
      sliding.add(std::span(events).subspan(begin == 0 ? 0 : begin + 200, begin == 0 ? 300 : 100));
      EventFrame drawn(lens_camera(k1));
      drawn.draw(std::span(events).subspan(begin, 300));
      for (int y = 0; y < drawn.height(); ++y)
        for (int x = 0; x < drawn.width(); ++x) ASSERT_EQ(sliding(x, y), drawn(x, y));
    }
    sliding.clear();
    EXPECT_EQ(sum(sliding), 0);
    sliding.add(std::span(events).first(1));
    sliding.remove(std::span(events).first(1));
    EXPECT_EQ(sum(sliding), 0) << "clear() forgets the counts, too";
  }
}

TEST(EventFrame, ASurfaceDecaysWithTheAgeOfTheLastEvent) {
  constexpr double kTau_s = 0.002;  // a fifth of the 10 ms of the events
  Events events;
  for (int i = 0; i <= 10; ++i) events.push_back(at(5 * i, 3 * i, i * 1'000'000));
  events.insert(events.begin() + 9, at(10, 6, 8'000'000));  // the third pixel again
  EventFrame frame(lens_camera());
  const TimeNs stamp = frame.draw_surface(events, 0.2);
  double weights = 0;
  double moment = 0;
  for (const Event& e : events) {
    const double t_s = seconds_from_ns(e.t_ns);
    const double weight = std::exp((t_s - 0.01) / kTau_s);
    const bool is_last = e.x != 10 || e.t_ns == 8'000'000;
    if (is_last) {
      EXPECT_NEAR(frame(e.x, e.y), EventFrame::kFull * weight, 0.51);
    }
    weights += weight;
    moment += weight * t_s;
  }
  EXPECT_NEAR(seconds_from_ns(stamp), moment / weights, 1e-8);
  EXPECT_GT(stamp, mean_time(events));
}

TEST(EventFrame, ASlowSurfaceIsTheBinaryFrame) {
  Events events;
  for (int i = 0; i < 200; ++i) events.push_back(at(i * 7 % 64, i * 5 % 48, 1000 * i));
  for (const double k1 : {0.0, -0.25}) {
    EventFrame surface(lens_camera(k1));
    EventFrame binary(lens_camera(k1));
    EXPECT_NEAR(static_cast<double>(surface.draw_surface(events, 1e7) - mean_time(events)), 0, 5);
    binary.draw(events);
    for (int y = 0; y < binary.height(); ++y)
      for (int x = 0; x < binary.width(); ++x) ASSERT_EQ(surface(x, y), binary(x, y));
  }
}

TEST(EventFrame, ASurfaceOfNoDurationIsFinite) {
  EventFrame frame(lens_camera());
  EXPECT_EQ(frame.draw_surface(Events{at(3, 4, 7)}, 0.5), 7);
  EXPECT_EQ(frame(3, 4), EventFrame::kFull);
}

TEST(EventFrame, HalvedIsTheMeanOfFourPixels) {
  PinholeCamera half = lens_camera();
  half.width /= 2;
  half.height /= 2;
  EventFrame fine(lens_camera());
  fine.draw(
      Events{at(0, 0), at(10, 10), at(11, 11), at(62, 46), at(63, 46), at(62, 47), at(63, 47)});
  EventFrame coarse(half);
  coarse.draw(Events{at(3, 3)});
  coarse.draw_halved(fine);
  EXPECT_EQ(coarse(0, 0), (EventFrame::kFull + 2) / 4);
  EXPECT_EQ(coarse(5, 5), (2 * EventFrame::kFull + 2) / 4);
  EXPECT_EQ(coarse(31, 23), EventFrame::kFull);
  EXPECT_NEAR(sum(coarse), 7 * EventFrame::kFull / 4, 3) << "what was there before is gone";
}

TEST(MeanTime, OfLargeStampsDoesNotOverflow) {
  const TimeNs start = 1'700'000'000'000'000'000;  // nanoseconds since 1970
  Events events;
  for (int i = 0; i < 1000; ++i) events.push_back(at(0, 0, start + 10 * i));
  EXPECT_EQ(mean_time(events), start + 4995);
  EXPECT_EQ(mean_time(Events{at(0, 0, -5)}), -5);
}

}  // namespace
}  // namespace saccade
