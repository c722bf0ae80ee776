#include "estimator/refinement/poses/increment_images.h"

#include <gtest/gtest.h>

#include "tests/unit/estimator/refinement/poses/tiny_sensor.h"

namespace saccade {
namespace {

using testing::tiny_camera;

Events eight_events() { return testing::ups_and_downs(5, 3); }

TEST(IncrementImages, AreSumsOfThresholdsOfAllPixels) {
  const auto images = observe_increments(eight_events(), tiny_camera(), {0.2, 0.3}, 4, 24);
  ASSERT_EQ(images.windows(), 2U);
  EXPECT_EQ(images.times_s, (std::vector<double>{0.001, 0.004, 0.008}));
  ASSERT_EQ(images.pixels.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(images.increment(0, i), i == 9 ? 0.8 : 0, 1e-6);
    EXPECT_NEAR(images.increment(1, i), i == 9 ? 0.2 - 0.9 : 0, 1e-6);
  }
  EXPECT_EQ(images.pixels[9].pixel, Eigen::Vector2f(1, 2));
  EXPECT_LT((images.pixels[9].ray - Eigen::Vector3d(-0.125, 0.25, 1)).norm(), 1e-6);
}

TEST(IncrementImages, AWindowIsNoShorterThanAsked) {
  const auto images = observe_increments(eight_events(), tiny_camera(), {0.2, 0.3}, 5, 1000000);
  EXPECT_EQ(images.windows(), 1U);
}

TEST(IncrementImages, AFewPixelsStandForAll) {
  const auto images = observe_increments(eight_events(), tiny_camera(), {0.2, 0.3}, 4, 12);
  EXPECT_EQ(images.pixels.size(), 6U);
  EXPECT_EQ(images.increments.size(), 12U);
}

TEST(IncrementImages, WithoutEventsThereAreNone) {
  EXPECT_EQ(observe_increments({}, tiny_camera(), {0.2, 0.3}, 5000, 1000000).windows(), 0U);
}

}  // namespace
}  // namespace saccade
