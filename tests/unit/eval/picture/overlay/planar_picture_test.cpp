#include "eval/picture/overlay/planar_picture.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace saccade {
namespace {

constexpr Rgb8 kGround{10, 20, 30};
constexpr Rgba8 kRed{255, 0, 0, 255};
constexpr Rgba8 kGreen{0, 255, 0, 255};
constexpr Rgba8 kBlue{0, 0, 255, 255};
constexpr Rgba8 kWhite{255, 255, 255, 255};

const PinholeCamera kFloorCamera{81, 61, 100, 100, 40, 30};

Rgb8 rgb(const Rgba8& colour) { return {colour[0], colour[1], colour[2]}; }

/// 8 x 8 texels: red and green above, blue and white below.
ImageRgba8 quarters() {
  ImageRgba8 picture(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      picture(x, y) = y < 4 ? (x < 4 ? kRed : kGreen) : (x < 4 ? kBlue : kWhite);
  return picture;
}

Rigid3 pose(double x, double y, double z, const Eigen::Vector3d& turn = Eigen::Vector3d::Zero()) {
  return {so3_exp(turn), {x, y, z}};
}

/// 0.4 m wide, 2 m before a camera at the origin: 20 px around (40, 30).
PlanarPicture ahead(const ImageRgba8& picture, double z = 2) {
  return {PicturePyramid(picture), pose(0, 0, z), 0.4};
}

struct Drawing {
  ImageRgb8 image;
  bool any;

  [[nodiscard]] bool is_ground() const { return image == ground(image); }
  static ImageRgb8 ground(const ImageRgb8& image) {
    return {image.width(), image.height(), kGround};
  }
};

Drawing draw(const PlanarPicture& picture, const Rigid3& world_from_camera = {}, int upscale = 1,
             const OcclusionTest& hides = {}, double opacity = 1) {
  Drawing result{{kFloorCamera.width * upscale, kFloorCamera.height * upscale, kGround}, false};
  result.any = draw_planar_picture(picture, {kFloorCamera, world_from_camera, upscale}, opacity,
                                   hides, result.image);
  return result;
}

TEST(PlanarPicture, TheHomographyIsTheProjectionOfThePlane) {
  const Random random(3);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto number = [&](std::uint64_t stream) { return random.normal(stream, i); };
    const Rigid3 camera_from_plane = pose(0.3 * number(0), 0.3 * number(1), 2 + 0.2 * number(2),
                                          {0.4 * number(3), 0.4 * number(4), 0.4 * number(5)});
    const Eigen::Vector3d point(0.2 * number(6), 0.2 * number(7), 0);
    const Eigen::Vector3d in_camera = camera_from_plane * point;
    ASSERT_GT(in_camera.z(), 0.5);
    const Eigen::Matrix3d from_plane = pixel_from_plane(kFloorCamera, camera_from_plane);
    const Eigen::Vector3d scaled = from_plane * Eigen::Vector3d(point.x(), point.y(), 1);
    const Eigen::Vector2d pixel = kFloorCamera.project(in_camera);
    EXPECT_LT((scaled.hnormalized() - pixel).norm(), 1e-9);
    EXPECT_NEAR(scaled.z(), in_camera.z(), 1e-12);
    const Eigen::Vector3d back = from_plane.inverse() * pixel.homogeneous();
    EXPECT_NEAR(back.z(), 1 / in_camera.z(), 1e-9);
    EXPECT_LT((back.hnormalized() - point.head<2>()).norm(), 1e-9);
  }
}

TEST(PlanarPicture, StandsAtItsPlaceXToTheRightAndYDown) {
  const ImageRgb8 image = draw(ahead(quarters())).image;
  EXPECT_EQ(image(33, 23), rgb(kRed));
  EXPECT_EQ(image(47, 23), rgb(kGreen));
  EXPECT_EQ(image(33, 37), rgb(kBlue));
  EXPECT_EQ(image(47, 37), rgb(kWhite));
  // Its edges cut the pixels 30 and 50 in two.
  EXPECT_EQ(image(29, 30), kGround);
  EXPECT_EQ(image(51, 30), kGround);
  EXPECT_NE(image(30, 27), kGround);
  EXPECT_NE(image(30, 27), rgb(kRed));
  EXPECT_EQ(image(31, 27), rgb(kRed));
}

TEST(PlanarPicture, StaysInTheWorldWhenTheCameraTurnsAndMoves) {
  const Rigid3 world_from_camera = pose(0.2, -0.1, 0.3, {0.05, -0.06, 0.3});
  const ImageRgb8 image = draw(ahead(quarters()), world_from_camera, 3).image;
  const ScreenView view{kFloorCamera, world_from_camera, 3};
  const auto seen = [&](double x, double y) {
    const Eigen::Vector3d in_camera = world_from_camera.inverse() * Eigen::Vector3d(x, y, 2);
    const Eigen::Vector2d at = view.screen_from_pixel(kFloorCamera.project(in_camera));
    return image(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
  };
  EXPECT_EQ(seen(-0.1, -0.1), rgb(kRed));
  EXPECT_EQ(seen(0.1, -0.1), rgb(kGreen));
  EXPECT_EQ(seen(-0.1, 0.1), rgb(kBlue));
  EXPECT_EQ(seen(0.1, 0.1), rgb(kWhite));
  EXPECT_EQ(seen(0.22, 0), kGround);
}

TEST(PlanarPicture, UpscalingKeepsItsPlace) {
  const ImageRgb8 image = draw(ahead(quarters()), {}, 4).image;
  // Sensor pixel 30 is cut in its middle, which is between the screen pixels 121 and 122.
  EXPECT_EQ(image(121, 110), kGround);
  EXPECT_EQ(image(122, 110), rgb(kRed));
}

TEST(PlanarPicture, BehindTheCameraOrEdgeOnNothingIsDrawn) {
  for (const PlanarPicture& picture :
       {ahead(quarters(), -2), PlanarPicture{PicturePyramid(quarters()),
                                             pose(0, 0, 2, {0, std::numbers::pi / 2, 0}), 0.4}}) {
    const Drawing drawn = draw(picture);
    EXPECT_FALSE(drawn.any);
    EXPECT_TRUE(drawn.is_ground());
    EXPECT_EQ(with_outline(drawn.image, ahead(quarters(), -2), {kFloorCamera, {}, 1}, rgb(kRed), 1),
              drawn.image);
  }
}

TEST(PlanarPicture, BesideTheImageNothingIsDrawn) {
  const Drawing drawn = draw({PicturePyramid(quarters()), pose(3, 0, 2), 0.4}, pose(0, 0, 0));
  EXPECT_FALSE(drawn.any);
  EXPECT_TRUE(drawn.is_ground());
}

TEST(PlanarPicture, NoSizeOrDistanceIsTooLarge) {
  for (const double size : {1e-300, 1e150, 1e300})
    for (const double z : {1e-300, 1e150, 1e300}) {
      const PlanarPicture picture{PicturePyramid(quarters()), pose(0, 0, z), size};
      const Drawing drawn = draw(picture);
      (void)with_outline(drawn.image, picture, {kFloorCamera, {}, 1}, rgb(kRed), 1);
    }
}

TEST(PlanarPicture, AFloorThatReachesBehindTheCameraIsDrawnUpToTheHorizon) {
  // 20 m wide, 0.5 m below the camera: what of it is behind would project above the horizon.
  const PlanarPicture floor{PicturePyramid(ImageRgba8(4, 4, kRed)),
                            pose(0, 0.5, 0, {std::numbers::pi / 2, 0, 0}), 20};
  const Drawing drawn = draw(floor);
  EXPECT_EQ(drawn.image(40, 60), rgb(kRed));
  EXPECT_EQ(drawn.image(40, 20), kGround);
  const ImageRgb8 framed =
      with_outline(drawn.image, floor, {kFloorCamera, {}, 1}, {255, 255, 0}, 1);
  EXPECT_NE(framed, drawn.image);
  EXPECT_EQ(framed(40, 20), kGround);
}

TEST(PlanarPicture, IsMirroredFromBehind) {
  const ImageRgb8 image =
      draw({PicturePyramid(quarters()), pose(0, 0, 2, {0, std::numbers::pi, 0}), 0.4}).image;
  EXPECT_EQ(image(33, 23), rgb(kGreen));
  EXPECT_EQ(image(47, 37), rgb(kBlue));
}

TEST(PlanarPicture, WhatIsNearerHidesIt) {
  double depth = 0;
  const ImageRgb8 image = draw(ahead(quarters()), {}, 1, [&](const Eigen::Vector3d& point) {
                            depth = point.z();
                            return point.x() < 0;
                          }).image;
  EXPECT_NEAR(depth, 2, 1e-12);
  EXPECT_EQ(image(33, 23), kGround);
  EXPECT_EQ(image(47, 23), rgb(kGreen));
}

TEST(PlanarPicture, AlphaBlendsInLinearLight) {
  ImageRgba8 picture(8, 8, Rgba8{255, 255, 255, 128});
  picture(6, 6) = {0, 0, 0, 0};
  EXPECT_NEAR(draw(ahead(picture)).image(35, 25)[0], 188, 1);
  EXPECT_NEAR(draw(ahead(ImageRgba8(8, 8, kWhite)), {}, 1, {}, 0.5).image(35, 25)[0], 188, 1);
  EXPECT_TRUE(draw(ahead(ImageRgba8(8, 8, Rgba8{255, 255, 255, 0}))).is_ground());
}

TEST(PlanarPicture, TransparentTexelsDoNotBleed) {
  // White with holes that are black below their alpha of 0: no sample may get darker than white.
  ImageRgba8 picture(64, 64, kWhite);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; x += 2) picture(x, y) = {0, 0, 0, 0};
  const PicturePyramid pyramid(picture);
  for (const double footprint : {1.0, 1.7, 2.0, 9.0, 64.0, 1e9}) {
    const Eigen::Array4f sample = pyramid.sample(20.3, 31.9, footprint);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(sample[i], sample[3], 1e-6F) << footprint;
  }
}

TEST(PlanarPicture, SmallPicturesShowTheirMean) {
  ImageRgba8 checks(257, 255);
  for (int y = 0; y < checks.height(); ++y)
    for (int x = 0; x < checks.width(); ++x)
      checks(x, y) = (x + y) % 2 == 0 ? kWhite : Rgba8{0, 0, 0, 255};
  const ImageRgb8 image = draw(ahead(checks)).image;
  // Half of white in linear light, without moire.
  for (int y = 22; y < 39; ++y)
    for (int x = 32; x < 49; ++x) EXPECT_NEAR(image(x, y)[0], 188, 3) << x << " " << y;
}

TEST(PlanarPicture, TheOutlineRunsThroughItsCorners) {
  const PlanarPicture picture = ahead(quarters());
  const ImageRgb8 image = with_outline(ImageRgb8(kFloorCamera.width, kFloorCamera.height, kGround),
                                       picture, {kFloorCamera, {}, 1}, rgb(kWhite), 1);
  for (const int x : {30, 40, 50}) {
    EXPECT_GT(image(x, 20)[0], 200);  // anti-aliased
    EXPECT_GT(image(x, 40)[0], 200);
  }
  EXPECT_EQ(image(40, 30), kGround);
}

}  // namespace
}  // namespace saccade
