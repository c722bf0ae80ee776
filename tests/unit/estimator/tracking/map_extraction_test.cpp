#include "estimator/tracking/map_extraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace saccade {
namespace {

constexpr int kMapWidth = 40;
constexpr int kMapHeight = 30;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

PinholeCamera map_camera() {
  PinholeCamera camera;
  camera.width = kMapWidth;
  camera.height = kMapHeight;
  camera.fx = 50;
  camera.fy = 60;
  camera.cx = 18.5;
  camera.cy = 14.25;
  return camera;
}

ImageF step_at(int column, float height = 1) {
  ImageF image(kMapWidth, kMapHeight);
  for (int y = 0; y < kMapHeight; ++y)
    for (int x = column; x < kMapWidth; ++x) image(x, y) = height;
  return image;
}

std::set<std::pair<int, int>> pixels_of(const MapPoints& map) {
  std::set<std::pair<int, int>> pixels;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector2d u = map_camera().project({map.x[i], map.y[i], map.z[i]});
    pixels.emplace(static_cast<int>(std::lround(u.x())), static_cast<int>(std::lround(u.y())));
  }
  return pixels;
}

std::set<int> columns_of(const MapPoints& map) {
  std::set<int> columns;
  for (const auto& [x, y] : pixels_of(map)) columns.insert(x);
  return columns;
}

TEST(ExtractMap, BackProjectsExactly) {
  ImageF depth(kMapWidth, kMapHeight);
  for (int y = 0; y < kMapHeight; ++y)
    for (int x = 0; x < kMapWidth; ++x) depth(x, y) = 2.0F + 0.001F * static_cast<float>(y);
  const MapPoints map = extract_map(step_at(20), depth, map_camera(), {});
  ASSERT_EQ(map.size(), 2 * (kMapHeight - 2)) << "two columns per step";
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector2d u = map_camera().project({map.x[i], map.y[i], map.z[i]});
    const Eigen::Vector2d pixel(std::round(u.x()), std::round(u.y()));
    EXPECT_LT((u - pixel).norm(), 1e-4);
    EXPECT_EQ(map.z[i], depth(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())));
  }
  EXPECT_EQ(columns_of(map), (std::set{19, 20}));
}

TEST(ExtractMap, ThresholdIsAShareOfTheLargestGradient) {
  ImageF image = step_at(30);
  for (int y = 0; y < kMapHeight; ++y)
    for (int x = 10; x < kMapWidth; ++x) image(x, y) += 0.2F;
  const ImageF depth(kMapWidth, kMapHeight, 2.0F);
  MapOptions options;
  options.min_gradient = 0.19;
  EXPECT_EQ(columns_of(extract_map(image, depth, map_camera(), options)),
            (std::set{9, 10, 29, 30}));
  options.min_gradient = 0.21;
  EXPECT_EQ(columns_of(extract_map(image, depth, map_camera(), options)), (std::set{29, 30}));
}

TEST(ExtractMap, MaxShareKeepsTheSteepestPixels) {
  // A parabola: the gradient grows from left to right.
  ImageF image(kMapWidth, kMapHeight);
  for (int y = 0; y < kMapHeight; ++y)
    for (int x = 0; x < kMapWidth; ++x) image(x, y) = static_cast<float>(x * x);
  MapOptions options;
  options.min_gradient = 0;
  options.max_fraction = 0.25;
  const MapPoints map =
      extract_map(image, ImageF(kMapWidth, kMapHeight, 2.0F), map_camera(), options);
  EXPECT_LE(map.size(), kMapWidth * kMapHeight / 4U);
  EXPECT_GE(map.size(), kMapWidth * kMapHeight / 5U);
  EXPECT_EQ(*columns_of(map).rbegin(), kMapWidth - 2);
  EXPECT_GE(*columns_of(map).begin(), 27);
}

TEST(ExtractMap, ThinKeepsOnePixelAcrossAnEdge) {
  // A smooth edge: ten columns of gradient, steepest between 19 and 20, on 20.
  ImageF image(kMapWidth, kMapHeight);
  for (int y = 0; y < kMapHeight; ++y)
    for (int x = 0; x < kMapWidth; ++x)
      image(x, y) = std::tanh((static_cast<float>(x) - 20.0F) / 3.0F);
  const ImageF depth(kMapWidth, kMapHeight, 2.0F);
  MapOptions options;
  EXPECT_GT(columns_of(extract_map(image, depth, map_camera(), options)).size(), 4U);
  options.thin = true;
  EXPECT_EQ(columns_of(extract_map(image, depth, map_camera(), options)), (std::set{20}));
  EXPECT_EQ(columns_of(extract_map(step_at(20), depth, map_camera(), options)).size(), 1U)
      << "two equally steep columns";
}

TEST(ExtractMap, UnknownDepthGivesNoPoint) {
  MapOptions options;
  options.foreground_depth = false;
  ImageF depth(kMapWidth, kMapHeight, 2.0F);
  for (int x = 0; x < kMapWidth; ++x) {
    depth(x, 10) = 0;
    depth(x, 12) = kNaN;
  }
  const auto pixels = pixels_of(extract_map(step_at(20), depth, map_camera(), options));
  EXPECT_FALSE(pixels.contains({20, 10}));
  EXPECT_FALSE(pixels.contains({20, 12}));
  EXPECT_TRUE(pixels.contains({20, 11}));
  for (const float unknown : {0.0F, kNaN}) {
    options.foreground_depth = true;
    EXPECT_EQ(
        extract_map(step_at(20), ImageF(kMapWidth, kMapHeight, unknown), map_camera(), options)
            .size(),
        0U);
  }
}

TEST(ExtractMap, EdgeBetweenTwoDepthsBelongsToTheNearerOne) {
  ImageF depth(kMapWidth, kMapHeight, 4.0F);
  for (int y = 0; y < kMapHeight; ++y)
    for (int x = 20; x < kMapWidth; ++x) depth(x, y) = 1.5F;
  MapOptions options;
  for (const float z : extract_map(step_at(20), depth, map_camera(), options).z) EXPECT_EQ(z, 1.5F);
  options.foreground_depth = false;
  std::set<float> depths;
  for (const float z : extract_map(step_at(20), depth, map_camera(), options).z) depths.insert(z);
  EXPECT_EQ(depths, (std::set{1.5F, 4.0F}));
}

TEST(ExtractMap, SlantedSurfaceKeepsItsOwnDepth) {
  ImageF depth(kMapWidth, kMapHeight);
  for (int y = 0; y < kMapHeight; ++y)
    for (int x = 0; x < kMapWidth; ++x) depth(x, y) = 2.0F - 0.02F * static_cast<float>(x);
  const MapPoints map = extract_map(step_at(20), depth, map_camera(), {});
  for (std::size_t i = 0; i < map.size(); ++i) {
    const int x =
        static_cast<int>(std::lround(map_camera().project({map.x[i], map.y[i], map.z[i]}).x()));
    EXPECT_EQ(map.z[i], depth(x, 5));
  }
}

TEST(ExtractMap, NoGradientNoMap) {
  EXPECT_EQ(extract_map(ImageF(kMapWidth, kMapHeight, 1), ImageF(kMapWidth, kMapHeight, 2),
                        map_camera(), {})
                .size(),
            0U);
}

TEST(ExtractMap, PixelsThatTheLensDoesNotShowAreIgnored) {
  ImageF image = step_at(20);
  for (int y = 0; y < kMapHeight; ++y) image(5, y) = kNaN;
  EXPECT_EQ(columns_of(extract_map(image, ImageF(kMapWidth, kMapHeight, 2), map_camera(), {})),
            (std::set{19, 20}));
}

}  // namespace
}  // namespace saccade
