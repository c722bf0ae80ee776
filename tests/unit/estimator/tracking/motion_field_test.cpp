#include "estimator/tracking/motion_field.h"

#include <gtest/gtest.h>

#include "estimator/tracking/event_frame.h"
#include "tests/unit/estimator/tracking/synthetic_template.h"

namespace saccade {
namespace {

using testing::add_point;
using testing::small_camera;

constexpr double kElsewhere_m = 5;

Twist velocity() {
  Twist twist;
  twist << 0.8, -0.5, 0.6, 0.3, -0.4, 0.9;
  return twist;
}

/// Where a point of the view at t = 0 is seen by the camera that moves with velocity().
Eigen::Vector2d seen_at(double t_s, const Eigen::Vector2d& pixel, double depth) {
  const Rigid3 start_from_camera = Rigid3::exp(velocity() * t_s);
  return small_camera().project(start_from_camera.inverse() * (depth * small_camera().ray(pixel)));
}

TEST(MotionField, IsTheDerivativeOfWhatIsSeen) {
  MapPoints map;
  const Eigen::Vector2d on_edge(40, 70);
  const Eigen::Vector2d elsewhere(100, 20);
  add_point(map, 2 * small_camera().ray(on_edge));
  TemplateDrawer drawer(small_camera(), {}, map);
  static_cast<void>(drawer.draw({}));
  const MotionField field(small_camera(), velocity(), drawer, kElsewhere_m);
  constexpr double kStep_s = 1e-5;
  for (const auto& [pixel, depth] : {std::pair(on_edge, 2.0), std::pair(elsewhere, kElsewhere_m)}) {
    const Eigen::Vector2d slope =
        (seen_at(kStep_s, pixel, depth) - seen_at(-kStep_s, pixel, depth)) / (2 * kStep_s);
    EXPECT_GT(slope.norm(), 20) << "the test must move";
    EXPECT_LT((field(pixel.cast<float>()).cast<double>() - slope).norm(), 1e-3 * slope.norm());
  }
}

TEST(MotionField, BringsTheEventsOfAnEdgeTogether) {
  // One point of the world fires along its way through the image; moved, all of its events meet.
  const MapPoints nothing;
  TemplateDrawer drawer(small_camera(), {}, nothing);
  static_cast<void>(drawer.draw({}));
  const MotionField field(small_camera(), velocity(), drawer, kElsewhere_m);
  const Eigen::Vector2d start(90, 50);
  Events events;
  for (int i = -20; i <= 20; ++i) {
    const double t_s = 1e-3 * i;
    const Eigen::Vector2d seen = seen_at(t_s, start, kElsewhere_m);
    events.push_back({ns_from_seconds(t_s), static_cast<std::uint16_t>(std::lround(seen.x())),
                      static_cast<std::uint16_t>(std::lround(seen.y())), 1});
  }
  const auto lit = [](const EventFrame& frame) {
    int count = 0;
    for (int y = 0; y < frame.height(); ++y)
      for (int x = 0; x < frame.width(); ++x) count += frame(x, y) > 0 ? 1 : 0;
    return count;
  };
  EventFrame raw(small_camera(), EventFrameOptions::Drawing::kNearest);
  raw.draw(events);
  EXPECT_GE(lit(raw), 4) << "the test must move";
  EventFrame moved(small_camera(), EventFrameOptions::Drawing::kNearest);
  moved.draw_moved(events, 0, field);
  EXPECT_LT(lit(moved), lit(raw));
  EXPECT_EQ(moved(90, 50), EventFrame::kFull);
  EventFrame bilinear(small_camera(), EventFrameOptions::Drawing::kBilinear);
  bilinear.draw_moved(events, 0, field);
  EXPECT_EQ(bilinear(90, 50), EventFrame::kFull);
}

TEST(MotionField, EventsThatLeaveTheImageAreDropped) {
  const MapPoints nothing;
  TemplateDrawer drawer(small_camera(), {}, nothing);
  static_cast<void>(drawer.draw({}));
  const MotionField field(small_camera(), 100 * velocity(), drawer, kElsewhere_m);
  for (const auto drawing :
       {EventFrameOptions::Drawing::kNearest, EventFrameOptions::Drawing::kBilinear}) {
    EventFrame frame(small_camera(), drawing);
    for (const TimeNs t_ns : {-100'000'000, 100'000'000})
      frame.draw_moved(Events{{0, 0, 0, 1}, {0, 159, 119, 1}}, t_ns, field);
    int total = 0;
    for (int y = 0; y < frame.height(); ++y)
      for (int x = 0; x < frame.width(); ++x) total += frame(x, y);
    EXPECT_EQ(total, 0);
  }
}

}  // namespace
}  // namespace saccade
