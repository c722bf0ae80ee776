#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "simulator/sensor/event_camera.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

/// Events of a plane with a checkerboard of single texels, 3.2 to a pixel, that moves past.
std::size_t count_events(TextureFilter filter) {
  ImageF board(512, 512);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x) board(x, y) = (x + y) % 2 == 0 ? 0.1F : 0.9F;
  const Scene scene =
      testing::scene_of({testing::rectangle({-2, -2, 2}, {4, 0, 0}, {0, 4, 0}, std::move(board))});
  const PinholeCamera camera{24, 16, 80, 80, 12, 8, {}};
  std::vector<StampedPose> poses(2);
  poses[1] = {0.2, Rigid3(Eigen::Quaterniond::Identity(), {0.1, 0.03, 0.02})};
  const Spline motion = Spline::interpolate(poses);
  EventOptions options;
  options.texture_filter = filter;
  std::size_t count = 0;
  EventCamera sensor(scene, motion, camera, options);
  sensor.record(0.2, [&](std::span<const SensedEvent> events, double) { count += events.size(); });
  return count;
}

TEST(TextureFilter, TextureFinerThanThePixelsFlickersOnlyWithoutIt) {
  EXPECT_GT(count_events(TextureFilter::kBilinear), 10000U);
  EXPECT_EQ(count_events(TextureFilter::kMipmap), 0U);
}

TEST(TextureFilter, UnknownOneIsNamedWithItsPlace) {
  const auto read = [](const std::string& yaml) {
    return config::read<EventOptions>(config::parse(yaml, "events.yaml", "/data"));
  };
  EXPECT_EQ(read("texture_filter: mipmap").texture_filter, TextureFilter::kMipmap);
  EXPECT_THAT(
      testing::error_of([&] { (void)read("texture_filter: cubic"); }),
      ::testing::AllOf(::testing::HasSubstr("texture_filter"), ::testing::HasSubstr("mipmap")));
}

}  // namespace
}  // namespace saccade
