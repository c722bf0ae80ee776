#include "core/panorama.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/io/images/panorama_file.h"
#include "tests/support/command.h"
#include "tests/support/direction_world.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::small_camera;
using testing::sweep;

std::vector<Eigen::Matrix3d> turns(const testing::OrientationFunction& turning, double end_s) {
  std::vector<Eigen::Matrix3d> result;
  for (double t_s = 0; t_s <= end_s; t_s += 0.01) result.push_back(turning(t_s).toRotationMatrix());
  return result;
}

std::size_t count(const ImageU8& mask) {
  return static_cast<std::size_t>(std::count(mask.pixels().begin(), mask.pixels().end(), 1));
}

TEST(Panorama, ShowsXInTheMiddleYLeftOfItAndTheZenithAbove) {
  const Panorama sphere = Panorama::sphere(400);
  EXPECT_TRUE(sphere.pixel({1, 0, 0}).isApprox(Eigen::Vector2d(199.5, 99.5)));
  EXPECT_TRUE(sphere.pixel({0, 2, 0}).isApprox(Eigen::Vector2d(99.5, 99.5)));
  EXPECT_NEAR(sphere.pixel({0, 0, 1}).y(), -0.5, 1e-9);
  EXPECT_NEAR(sphere.pixel({0, 0, -1}).y(), 199.5, 1e-9);
}

TEST(Panorama, PixelsAndDirectionsAreInverse) {
  const Panorama part{400, 350, 40, 120, 90};
  for (const double x : {0.0, 30.25, 119.0})
    for (const double y : {0.0, 50.5, 89.0})
      EXPECT_LT((part.pixel(part.direction(x, y)) - Eigen::Vector2d(x, y)).norm(), 1e-9);
}

TEST(Panorama, SolidAnglesAddUpToTheSphere) {
  const Panorama sphere = Panorama::sphere(64);
  double sum = 0;
  for (int y = 0; y < sphere.height; ++y) sum += sphere.width * sphere.solid_angle(y);
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-9);
}

TEST(Panorama, AFieldOfViewCoversItsSolidAngle) {
  const FieldOfView camera(small_camera());
  const Panorama sphere = Panorama::sphere(1200);
  const std::vector<Eigen::Matrix3d> turn = {sweep(3.0, 0)(0).toRotationMatrix()};
  const ImageU8 seen = seen_by(camera, turn, sphere);
  double sum = 0;
  for (int y = 0; y < sphere.height; ++y)
    for (int x = 0; x < sphere.width; ++x) sum += seen(x, y) * sphere.solid_angle(y);
  EXPECT_NEAR(sum, camera.solid_angle(), 0.01 * sum);
}

/// Wherever it looks, across the seam and up to the zenith, too.
TEST(Panorama, ThePartAroundASweepHoldsAllOfIt) {
  const FieldOfView camera(small_camera());
  for (const double start : {0.0, 2.5, -3.0}) {
    const auto swept = turns(sweep(start, 1.5), 0.8);
    const Panorama part = panorama_around(camera, swept, 60);
    EXPECT_EQ(error_of([&] { part.check("part"); }), "no error");
    EXPECT_FALSE(part.wraps());
    EXPECT_LT(part.width, part.around / 2);
    EXPECT_GE(part.pixels_per_radian(), 60);
    EXPECT_EQ(part.width % 2 + part.height % 2, 0);
    EXPECT_EQ(count(seen_by(camera, swept, part)),
              count(seen_by(camera, swept, Panorama::sphere(part.around))));
  }
}

TEST(Panorama, AWholeTurnWraps) {
  const Panorama part = panorama_around(FieldOfView(small_camera()), turns(sweep(0, 6), 1.4), 60);
  EXPECT_TRUE(part.wraps());
  EXPECT_LT(part.height, part.around / 2);
}

TEST(PanoramaFile, ReadsWhatItWrote) {
  const testing::TemporaryFolder folder;
  const Panorama part{400, 350, 40, 120, 90};
  write_panorama(folder.path() / "mosaic.yaml", part);
  EXPECT_EQ(read_panorama(folder.path() / "mosaic.yaml"), part);
}

TEST(PanoramaFile, NamesWhatIsWrong) {
  const testing::TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    return error_of([&] { return read_panorama(folder.write("mosaic.yaml", text)); });
  };
  EXPECT_THAT(error("{around: 400, left: 0, top: 0, width: 40}"), HasSubstr("height"));
  EXPECT_THAT(error("{around: 400, left: 0, top: 190, width: 40, height: 20}"),
              HasSubstr("top and height"));
  EXPECT_THAT(error("{around: 400, left: 0, top: 0, width: 401, height: 20}"),
              HasSubstr("left and width"));
  EXPECT_THAT(error("{around: 3, left: 0, top: 0, width: 2, height: 2}"), HasSubstr("around"));
}

}  // namespace
}  // namespace saccade
