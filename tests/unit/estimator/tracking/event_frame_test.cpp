#include "estimator/tracking/event_frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

using Drawing = EventFrameOptions::Drawing;

PinholeCamera camera(double k1 = 0) {
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
  for (const Drawing drawing : {Drawing::kNearest, Drawing::kBilinear}) {
    EventFrame frame(camera(), drawing);
    frame.draw(Events{at(0, 0), at(30, 20), at(30, 20), at(63, 47)});
    EXPECT_EQ(frame(0, 0), EventFrame::kFull);
    EXPECT_EQ(frame(30, 20), EventFrame::kFull) << "twice is no more than once";
    EXPECT_EQ(frame(63, 47), EventFrame::kFull);
    EXPECT_EQ(sum(frame), 3 * EventFrame::kFull);
    frame.clear();
    EXPECT_EQ(sum(frame), 0);
  }
}

TEST(EventFrame, PolarityIsIgnored) {
  EventFrame frame(camera(), Drawing::kNearest);
  Event off = at(7, 8);
  off.polarity = -1;
  frame.draw(std::span(&off, 1));
  EXPECT_EQ(frame(7, 8), EventFrame::kFull);
}

TEST(EventFrame, MovesEventsToTheUndistortedPixel) {
  const PinholeCamera lens = camera(-0.25);
  int moved = 0;
  for (int y = 0; y < lens.height; y += 3)
    for (int x = 0; x < lens.width; x += 3) {
      const Eigen::Vector2d p = lens.undistort({x, y});
      const int px = static_cast<int>(std::lround(p.x()));
      const int py = static_cast<int>(std::lround(p.y()));
      const bool inside = px >= 0 && py >= 0 && px < lens.width && py < lens.height;
      EventFrame frame(lens, Drawing::kNearest);
      frame.draw(Events{at(x, y)});
      EXPECT_EQ(sum(frame), inside ? EventFrame::kFull : 0) << x << ' ' << y;
      if (inside) {
        EXPECT_EQ(frame(px, py), EventFrame::kFull) << x << ' ' << y;
      }
      moved += static_cast<int>(px != x || py != y);
    }
  EXPECT_GT(moved, 100) << "the lens must matter";
}

TEST(EventFrame, BilinearDrawingKeepsTheSubPixelPosition) {
  const PinholeCamera lens = camera(-0.25);
  for (int y = 12; y < 36; y += 5)
    for (int x = 16; x < 48; x += 5) {
      const Eigen::Vector2d expected = lens.undistort({x, y});
      EventFrame frame(lens, Drawing::kBilinear);
      frame.draw(Events{at(x, y)});
      Eigen::Vector2d centre(0, 0);
      for (int v = 0; v < lens.height; ++v)
        for (int u = 0; u < lens.width; ++u) centre += frame(u, v) * Eigen::Vector2d(u, v);
      EXPECT_NEAR(sum(frame), EventFrame::kFull, 2) << "one event weighs one, to rounding";
      EXPECT_LT((centre / sum(frame) - expected).norm(), 0.02);
    }
}

TEST(EventFrame, BilinearWeightsSaturate) {
  const PinholeCamera lens = camera(-0.25);
  EventFrame frame(lens, Drawing::kBilinear);
  for (int i = 0; i < 100; ++i) frame.draw(Events{at(20, 20)});
  const Eigen::Vector2d p = lens.undistort({20, 20});
  EXPECT_EQ(frame(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))),
            EventFrame::kFull);
  EXPECT_LE(sum(frame), 4 * EventFrame::kFull);
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
