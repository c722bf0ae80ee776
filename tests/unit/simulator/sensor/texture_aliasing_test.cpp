#include "simulator/sensor/texture_aliasing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Two metres from a plane whose texels of 1 / 128 m are 3.2 to a pixel of 1 / 40 m.
double texels_seen(const EventOptions& options, bool has_texture = true) {
  Mesh plane = testing::rectangle({-2, -2, 2}, {4, 0, 0}, {0, 4, 0}, ImageF(512, 512));
  if (!has_texture) plane.materials.front().texture = nullptr;
  const std::vector<StampedPose> poses{{0, Rigid3()},
                                       {0.2, Rigid3(Eigen::Quaterniond::Identity(), {0.1, 0, 0})}};
  return texels_per_ray(testing::scene_of({plane}), Spline::interpolate(poses),
                        {24, 16, 80, 80, 11.5, 7.5, {}}, options);
}

TEST(TextureAliasing, CountsTheTexelsOfARay) {
  EventOptions options;
  EXPECT_NEAR(texels_seen(options), 3.2, 1e-6);
  options.samples_per_pixel = 4;
  EXPECT_NEAR(texels_seen(options), 1.6, 1e-6);
  EXPECT_EQ(texels_seen(options, false), 0);
}

TEST(TextureAliasing, WarnsOfTextureThatRaysSkip) {
  EventOptions options;
  EXPECT_THAT(aliasing_warning(texels_seen(options), options),
              AllOf(HasSubstr("3.2 texels"), HasSubstr("events.texture_filter: mipmap"),
                    HasSubstr("events.samples_per_pixel: 4")));
  options.samples_per_pixel = 4;
  EXPECT_EQ(aliasing_warning(texels_seen(options), options), "");
  EXPECT_THAT(aliasing_warning(8, options),
              AllOf(HasSubstr("mipmap"), Not(HasSubstr("samples_per_pixel"))));
  options.texture_filter = TextureFilter::kMipmap;
  EXPECT_EQ(aliasing_warning(8, options), "");
}

}  // namespace
}  // namespace saccade
