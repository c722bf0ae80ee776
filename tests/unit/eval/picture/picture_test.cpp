#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/image/event_picture.h"
#include "eval/picture/image/image_picture.h"
#include "eval/picture/image/map_picture.h"
#include "eval/picture/image/trajectory_picture.h"

namespace saccade {
namespace {

double lightness(const Rgb8& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

TEST(OrderedColour, GrowsLighterAllTheWay) {
  for (int i = 0; i < 50; ++i)
    EXPECT_LT(lightness(ordered_colour(i / 50.0)), lightness(ordered_colour((i + 1) / 50.0)));
}

TEST(OrderedColour, ClampsAndSurvivesNan) {
  EXPECT_EQ(ordered_colour(-3), ordered_colour(0));
  EXPECT_EQ(ordered_colour(7), ordered_colour(1));
  EXPECT_EQ(ordered_colour(std::nan("")), ordered_colour(0));
}

TEST(Canvas, UpscalesToSquares) {
  ImageRgb8 image(2, 1);
  image(1, 0) = {1, 2, 3};
  const ImageRgb8 large = upscale(image, 3);
  EXPECT_EQ(large.width(), 6);
  EXPECT_EQ(large.height(), 3);
  EXPECT_EQ(large(2, 2), (Rgb8{0, 0, 0}));
  EXPECT_EQ(large(3, 0), (Rgb8{1, 2, 3}));
}

TEST(Canvas, CutsOffWhatFallsOutside) {
  Canvas canvas(4, 4, {9, 9, 9});
  canvas.paste(ImageRgb8(3, 3, {1, 1, 1}), -2, 2);
  EXPECT_EQ(canvas.image()(0, 2), (Rgb8{1, 1, 1}));
  EXPECT_EQ(canvas.image()(1, 2), (Rgb8{9, 9, 9}));
  canvas.paste(ImageRgb8(3, 3, {1, 1, 1}), 9, 9);
  canvas.line({-1e9, 0}, {1e12, std::nan("")}, {0, 0, 0});
}

TEST(EventPicture, ShowsTheLastPolarityAndTheCount) {
  const Events events{{1, 0, 0, 1}, {2, 0, 0, -1}, {3, 1, 0, 1}, {4, 9, 9, 1}};
  const ImageRgb8 picture = draw_events(events, 3, 2, kLightTheme);
  EXPECT_EQ(picture(2, 1), kLightTheme.background);
  EXPECT_EQ(picture(0, 0), mix(kLightTheme.background, kLightTheme.off, 0.8));
  EXPECT_EQ(picture(1, 0), mix(kLightTheme.background, kLightTheme.on, 0.6));
}

TEST(EventPicture, TakesTheEventsNearestInTime) {
  Events events;
  for (int i = 0; i < 100; ++i) events.push_back({i * 1'000'000, 0, 0, 1});
  const std::span<const Event> near = events_around(events, 0.05, 5);
  ASSERT_EQ(near.size(), 5U);
  EXPECT_EQ(near.front().t_ns, 48'000'000);
  EXPECT_EQ(near.back().t_ns, 52'000'000);
  EXPECT_EQ(events_around(events, -1, 5).size(), 0U);
  EXPECT_EQ(events_around(events, 0, 500).size(), 100U);
  EXPECT_EQ(events_around(events, 0.05, 500, 0.002).size(), 5U);
  EXPECT_EQ(events_around(events, 0.0, 3).size(), 3U);
  EXPECT_TRUE(events_around({}, 0, 3).empty());
}

TEST(EventPicture, UndistortsToTheNearestPixel) {
  PinholeCamera camera{100, 80, 90, 90, 49.5, 39.5, {}};
  const Events events{{1, 3, 4, 1}, {2, 50, 40, -1}};
  EXPECT_EQ(undistort_events(events, camera), events);
  camera.distortion = {-0.2, 0, 0, 0, 0};  // barrel: the corners move outwards, off the sensor
  const Events straight = undistort_events(events, camera);
  ASSERT_EQ(straight.size(), 1U);
  EXPECT_EQ(straight[0].x, 50);
  EXPECT_EQ(straight[0].y, 40);
}

TEST(ImagePicture, DepthColoursRunFromNearToFar) {
  ImageF depth(4, 1);
  depth(0, 0) = 1;
  depth(1, 0) = 2;
  depth(2, 0) = 4;
  const DepthRange range{1, 4};
  const ImageRgb8 picture = draw_depth(depth, range, kDarkTheme);
  EXPECT_EQ(picture(0, 0), ordered_colour(1));
  EXPECT_EQ(picture(2, 0), ordered_colour(0));
  EXPECT_EQ(picture(1, 0), ordered_colour(1.0 / 3));  // (1/2 - 1/4) / (1 - 1/4)
  EXPECT_EQ(picture(3, 0), kDarkTheme.faint);
}

TEST(ImagePicture, TheRangeIgnoresWhatIsNoDepth) {
  ImageF depth(3, 1);
  depth(0, 0) = 2;
  depth(1, 0) = std::numeric_limits<float>::infinity();
  const DepthRange range = depth_range(depth);
  EXPECT_FLOAT_EQ(static_cast<float>(range.near_m), 2);
  EXPECT_GT(range.far_m, range.near_m);
  EXPECT_GT(depth_range(ImageF(2, 2)).far_m, 0);
}

TEST(ImagePicture, UndistortingAStraightImageChangesNothing) {
  ImageF image(5, 4);
  for (std::size_t i = 0; i < image.size(); ++i) image.pixels()[i] = static_cast<float>(i);
  PinholeCamera camera{5, 4, 10, 10, 2, 1.5, {}};
  EXPECT_EQ(undistort_image(image, camera), image);
  camera.distortion = {1e-9, 0, 0, 0, 0};
  EXPECT_NEAR(undistort_image(image, camera)(2, 2), image(2, 2), 1e-3);
}

TEST(MapOverlay, SeesOnlyTheFrontMostPoints) {
  const PinholeCamera camera{40, 30, 40, 40, 19.5, 14.5, {}};
  const std::vector<Eigen::Vector3f> points{
      {0, 0, 2}, {0, 0, 4}, {0.5F, 0, 4}, {0, 0, -2}, {9, 0, 1}};
  const auto visible = visible_points(points, {}, camera);
  ASSERT_EQ(visible.size(), 2U);
  EXPECT_NEAR(visible[0].x(), 19.5, 1e-6);
  EXPECT_NEAR(visible[1].x(), 24.5, 1e-6);
}

TEST(MapOverlay, MapAndEventAddUpWhereTheyMeet) {
  const PinholeCamera camera{8, 6, 8, 8, 3.5, 2.5, {}};
  const Events events{{0, 2, 1, 1}};
  const std::vector<Eigen::Vector2d> map{{2, 1}, {5, 4}};
  const ImageRgb8 picture = draw_map_over_events(events, map, camera, 3, kDarkTheme);
  EXPECT_EQ(picture.width(), 24);
  const Rgb8 both = picture(2 * 3, 1 * 3);
  const Rgb8 map_alone = picture(5 * 3, 4 * 3);
  EXPECT_GT(both[1], map_alone[1]);
  EXPECT_GT(map_alone[2], kDarkTheme.background[2]);
  EXPECT_EQ(picture(0, 0), kDarkTheme.background);
}

TEST(TrajectoryPicture, DrawsNothingStandingAndStraight) {
  const std::vector<Eigen::Vector3d> still(3, Eigen::Vector3d(1, 2, 3));
  const std::vector<Eigen::Vector3d> straight{{0, 0, 0}, {1, 0, 0}};
  for (const auto& truth : {std::vector<Eigen::Vector3d>{}, still, straight}) {
    const ImageRgb8 picture = draw_trajectory(truth, straight, 200, 150, kDarkTheme);
    EXPECT_EQ(picture.width(), 200);
  }
  EXPECT_EQ(draw_trajectory({}, {}, 200, 150, kLightTheme).height(), 150);
}

TEST(ContactSheet, LongCaptionsGoOnInFurtherLines) {
  const auto sheet_of = [](const std::string& caption) {
    ContactSheet sheet("t", kLightTheme);
    sheet.add_row("", {{caption, ImageRgb8(120, 40)}, {"short", ImageRgb8(120, 40)}});
    return sheet.draw();
  };
  const ImageRgb8 one = sheet_of("short");
  const ImageRgb8 several = sheet_of("a caption of many words that is far wider than its picture");
  EXPECT_EQ(several.width(), one.width());
  EXPECT_GT(several.height(), one.height());
  // Nothing is written between the pictures, beside the one that the caption is of.
  for (int y = 40; y < several.height(); ++y) EXPECT_EQ(several(16 + 120 + 8, y), several(2, y));
}

TEST(ContactSheet, HoldsItsRows) {
  ContactSheet sheet("title", kLightTheme);
  sheet.add_row("a", {{"one", ImageRgb8(100, 50)}, {"two", ImageRgb8(100, 70)}});
  sheet.add_row("b", {{"three", ImageRgb8(100, 50)}});
  const ImageRgb8 picture = sheet.draw();
  EXPECT_GE(picture.width(), 200);
  EXPECT_GE(picture.height(), 120);
}

}  // namespace
}  // namespace saccade
