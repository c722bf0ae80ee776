#include "simulator/scene/light/gloss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/scene/light/vector_range.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

// Of the microfacets of a rough surface, each by the cosine of its slope, the areas add up to the
// surface's: 4 / pi lobe is their density, whatever the roughness.
TEST(Gloss, TheLobeIsADensityOfMicrofacets) {
  constexpr int kSteps = 200'000;
  for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
    const Gloss gloss = make_gloss(1, roughness);
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double a = (k + 0.5) / kSteps * std::numbers::pi / 2;
      const double sine = std::sin(a);
      sum += 4 / std::numbers::pi * gloss.factor(sine * sine) * std::cos(a) * 2 * std::numbers::pi *
             sine;
    }
    EXPECT_NEAR(sum * std::numbers::pi / 2 / kSteps, 1, 1e-5) << roughness;
  }
}

TEST(Gloss, SurfacesSmootherThanTheSmoothestAreAsThat) {
  EXPECT_EQ(make_gloss(0.5, 0).alpha, make_gloss(0.5, kLeastRoughness).alpha);
  EXPECT_EQ(make_gloss(0.5, 7).alpha, 1);
  EXPECT_TRUE(Gloss{}.is_matt());
}

// s rises from 0.1 to 0.3 and falls again, or any part of that.
TEST(Gloss, BoundsHoldWithinAnInterval) {
  for (const double roughness : {0.1, 0.4, 1.0}) {
    const Gloss gloss = make_gloss(0.3, roughness);
    const auto s_at = [](double t) { return 0.1 + 0.2 * std::sin(t); };
    for (const auto& [from, to] : {std::pair{0.0, 0.2}, {0.2, 1.4}, {0.5, 3.0}, {2.0, 3.1}}) {
      LightRange s{1, 0, 1e9, -1e9};
      for (int k = 0; k <= 1000; ++k) {
        const double t = std::lerp(from, to, k / 1000.0);
        s.low = std::min(s.low, s_at(t));
        s.high = std::max(s.high, s_at(t));
        s.rate_low = std::min(s.rate_low, 0.2 * std::cos(t));
        s.rate_high = std::max(s.rate_high, 0.2 * std::cos(t));
      }
      const LightRange range = gloss.factor_range(s);
      for (int k = 0; k <= 1000; ++k) {
        const double t = std::lerp(from, to, k / 1000.0);
        const double value = gloss.factor(s_at(t));
        const double rate = (gloss.factor(s_at(t + 1e-6)) - gloss.factor(s_at(t - 1e-6))) / 2e-6;
        EXPECT_GE(value, range.low - 1e-12);
        EXPECT_LE(value, range.high + 1e-12);
        EXPECT_GE(rate, range.rate_low - 1e-6);
        EXPECT_LE(rate, range.rate_high + 1e-6);
      }
    }
  }
}

/// A glossy floor of albedo 0.5 at z = 2 before a camera that looks along z.
Scene floor_scene(const std::vector<LightOptions>& lights, const Gloss& gloss) {
  Mesh floor = testing::rectangle({-10, -10, 2}, {20, 0, 0}, {0, 20, 0}, ImageF(2, 2, 0.5F));
  floor.materials.front().gloss = gloss;
  SceneBuilder builder;
  builder.add(floor, Eigen::Affine3d::Identity());
  builder.light(0.25, lights);
  return std::move(builder).build(Background(0));
}

// From the angle between the normal and the halfway direction, both found by trigonometry in the
// plane of eye, light and point.
TEST(Gloss, AHighlightIsTheClosedForm) {
  LightOptions lamp;
  lamp.position = {3, 0, 0.5};
  lamp.intensity = 4;
  constexpr double kReflectance = 0.3, kRoughness = 0.35;
  const double alpha = kRoughness * kRoughness;
  const Scene scene = floor_scene({lamp}, make_gloss(kReflectance, kRoughness));
  for (const double x : {-2.0, 0.0, 1.0, 1.6, 1.7, 1.75, 2.0, 3.0}) {
    const double to_eye = std::atan2(-x, 2.0), to_lamp = std::atan2(3 - x, 1.5);
    const double sine = std::sin(0.5 * (to_eye + to_lamp));
    const double irradiance = 4 * std::cos(to_lamp) / ((3 - x) * (3 - x) + 1.5 * 1.5);
    const double divisor = alpha * alpha + (1 - alpha * alpha) * sine * sine;
    const double mirrored = irradiance * kReflectance * alpha * alpha / (4 * divisor * divisor);
    const double expected = 0.5 * (0.25 + irradiance) + mirrored;
    EXPECT_NEAR(testing::see(scene, {{0, 0, 0}, {x, 0, 2}}).radiance, expected, 1e-6 * expected)
        << x;
  }
}

TEST(Gloss, ALightThatIsHiddenIsNotMirrored) {
  LightOptions lamp;
  lamp.position = {3, 0, 0.5};
  Mesh floor = testing::rectangle({-10, -10, 2}, {20, 0, 0}, {0, 20, 0}, ImageF(2, 2, 0.5F));
  floor.materials.front().gloss = make_gloss(0.3, 0.3);
  SceneBuilder builder;
  builder.add(floor, Eigen::Affine3d::Identity());
  builder.add(testing::rectangle({2, -1, 1}, {1.5, 0, 0}, {0, 2, 0}, ImageF(2, 2, 1)),
              Eigen::Affine3d::Identity());
  builder.light(0.25, {lamp});
  const Scene scene = std::move(builder).build(Background(0));
  EXPECT_NEAR(testing::see(scene, {{0, 0, 0}, {1.7, 0, 2}}).radiance, 0.125, 1e-9);
}

}  // namespace
}  // namespace saccade
