#include "simulator/sensor/adaptive/arc_signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "simulator/sensor/adaptive/surface_arc.h"

namespace saccade {
namespace {

constexpr double kEps = 1e-3;
constexpr double kTolerance_s = 1e-6;
constexpr double kFrom_s = 2;
constexpr double kLength_s = 0.01;

/// Columns of these values, eight times.
Texture columns(const std::vector<float>& values) {
  ImageF image(static_cast<int>(values.size()), 8);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) image(x, y) = values[static_cast<std::size_t>(x)];
  return Texture(std::move(image));
}

SurfaceSample seen_at(const Texture* texture, double x, double y, double irradiance = 1,
                      double level = 0) {
  SurfaceSample seen;
  seen.texture = texture;
  seen.x = x;
  seen.y = y;
  seen.irradiance = irradiance;
  seen.distance = 1;
  seen.level = level;
  return seen;
}

/// Evenly from one column to another.
SurfaceArc even_arc(const Texture& texture, double from_x, double to_x, double level = 0) {
  return {kFrom_s, kFrom_s + kLength_s, seen_at(&texture, from_x, 3, 1, level),
          seen_at(&texture, 0.5 * (from_x + to_x), 3, 1, level),
          seen_at(&texture, to_x, 3, 1, level)};
}

std::optional<Bracket<ArcSample>> first_exit(const SurfaceArc& arc, double half_band) {
  const ArcSignal signal(arc, kEps, kTolerance_s);
  const ArcSample from = signal.at(kFrom_s);
  const Thresholds thresholds({from.log_intensity - half_band, from.log_intensity + half_band}, 0,
                              kEps, kFrom_s);
  return signal.first_exit(thresholds, from, signal.at(kFrom_s + kLength_s));
}

TEST(SurfaceArc, IsExactForParabolas) {
  const Texture texture = columns({0.F, 1.F, 2.F, 3.F, 4.F, 5.F, 6.F, 7.F});
  const auto x = [](double u) { return 1.2 + 2 * u + 0.3 * u * u; };
  const auto light = [](double u) { return 0.5 + 0.2 * u; };
  const SurfaceArc arc(kFrom_s, kFrom_s + kLength_s, seen_at(&texture, x(0), 3, light(0)),
                       seen_at(&texture, x(0.5), 3, light(0.5)),
                       seen_at(&texture, x(1), 3, light(1)));
  EXPECT_TRUE(arc.is_smooth());
  for (double u = 0; u <= 1; u += 0.125)
    EXPECT_NEAR(arc.radiance_at(kFrom_s + u * kLength_s), light(u) * x(u), 1e-6) << u;
}

TEST(SurfaceArc, WithoutATextureTheAlbedoIsFollowed) {
  const SurfaceArc arc(0, 1, seen_at(nullptr, 0.2, 0, 2), seen_at(nullptr, 0.3, 0, 2),
                       seen_at(nullptr, 0.4, 0, 2));
  EXPECT_NEAR(arc.radiance_at(0.25), 2 * 0.25, 1e-12);
  EXPECT_EQ(arc.next_border_s(0, 1), 1);
}

TEST(SurfaceArc, BordersAreThoseOfTheTexels) {
  const Texture texture = columns({0.F, 1.F, 0.F, 1.F, 0.F, 1.F, 0.F, 1.F});
  const SurfaceArc arc = even_arc(texture, 1.3, 3.7);
  const double end_s = kFrom_s + kLength_s;
  const double second_s = kFrom_s + (2 - 1.3) / 2.4 * kLength_s;
  const double third_s = kFrom_s + (3 - 1.3) / 2.4 * kLength_s;
  EXPECT_NEAR(arc.next_border_s(kFrom_s, end_s), second_s, 1e-12);
  EXPECT_NEAR(arc.next_border_s(second_s, end_s), third_s, 1e-12);
  EXPECT_EQ(arc.next_border_s(third_s, end_s), end_s);
  EXPECT_EQ(arc.next_border_s(kFrom_s, kFrom_s + 1e-4), kFrom_s + 1e-4);
  // The other way.
  const SurfaceArc back = even_arc(texture, 3.7, 1.3);
  EXPECT_NEAR(back.next_border_s(kFrom_s, end_s), kFrom_s + (3.7 - 3) / 2.4 * kLength_s, 1e-12);
}

TEST(SurfaceArc, BordersOfFilteredTexturesAreThoseOfBothPictures) {
  const Texture texture = columns({0.F, 1.F, 0.F, 1.F, 0.F, 1.F, 0.F, 1.F});
  // Level 1 has texels at 0.5, 2.5, 4.5, level 2 at 1.5, 5.5.
  const SurfaceArc arc = even_arc(texture, 1, 3, 1.5);
  const double end_s = kFrom_s + kLength_s;
  const double first_s = kFrom_s + (1.5 - 1) / 2 * kLength_s;
  const double second_s = kFrom_s + (2.5 - 1) / 2 * kLength_s;
  EXPECT_NEAR(arc.next_border_s(kFrom_s, end_s), first_s, 1e-12);
  EXPECT_NEAR(arc.next_border_s(first_s, end_s), second_s, 1e-12);
  EXPECT_EQ(arc.next_border_s(second_s, end_s), end_s);
}

TEST(SurfaceArc, RaysThatGrazeAreNoParabola) {
  const Texture texture = columns({0.F, 1.F, 0.F, 1.F, 0.F, 1.F, 0.F, 1.F});
  const SurfaceSample from = seen_at(&texture, 0, 3);
  const SurfaceSample to = seen_at(&texture, 6, 3);
  EXPECT_FALSE(SurfaceArc(0, 1, from, seen_at(&texture, 1, 3), to).is_smooth());
  EXPECT_TRUE(SurfaceArc(0, 1, from, seen_at(&texture, 2.9, 3), to).is_smooth());
  SurfaceSample missed = seen_at(&texture, 3, 3);
  missed.distance = 0;
  EXPECT_FALSE(SurfaceArc(0, 1, from, missed, to).is_smooth());
}

TEST(ArcSignal, ADipBetweenEqualEndsIsFound) {
  // From 0.4 down to black at column 2 and up again to 0.4, with the middle of the arc elsewhere.
  const Texture texture = columns({0.8F, 0.8F, 0.F, 0.8F, 0.8F, 0.8F, 0.8F, 0.8F});
  const SurfaceArc arc = even_arc(texture, 1.5, 2.5);
  const auto exit = first_exit(arc, 0.2);
  ASSERT_TRUE(exit);
  const double level = std::log(kEps + 0.4) - 0.2;
  EXPECT_GT(exit->lo.log_intensity, level);
  EXPECT_LE(exit->hi.log_intensity, level);
  // The radiance is 0.4 - 0.8 u.
  const double exact_s = kFrom_s + (0.4 - (std::exp(level) - kEps)) / 0.8 * kLength_s;
  EXPECT_LE(exit->lo.t_s, exact_s);
  EXPECT_GE(exit->hi.t_s, exact_s);
}

TEST(ArcSignal, ASecondLevelBehindADipDoesNotHideIt) {
  // Ends above the band, but leaves it below first.
  const Texture texture = columns({0.8F, 0.8F, 0.F, 2.F, 2.F, 2.F, 2.F, 2.F});
  const auto exit = first_exit(even_arc(texture, 1.5, 2.9), 0.2);
  ASSERT_TRUE(exit);
  EXPECT_LT(exit->hi.log_intensity, std::log(kEps + 0.4) - 0.2);
}

TEST(ArcSignal, WhatStaysInTheBandHasNoExit) {
  const Texture texture = columns({0.80F, 0.80F, 0.75F, 0.80F, 0.80F, 0.80F, 0.80F, 0.80F});
  EXPECT_FALSE(first_exit(even_arc(texture, 1.5, 2.5), 0.2));
  EXPECT_TRUE(first_exit(even_arc(texture, 1.5, 2.5), 0.02));
}

TEST(ArcSignal, TheFinestTextureEndsAsWell) {
  const Texture texture = columns({0.79F, 0.81F, 0.79F, 0.81F, 0.79F, 0.81F, 0.79F, 0.81F});
  EXPECT_FALSE(first_exit(even_arc(texture, 0, 1e9), 0.2));
}

TEST(ArcSignal, DividingTheFinestTextureComesToTheToleranceSoon) {
  const Texture texture = columns({0.79F, 0.81F, 0.79F, 0.81F, 0.79F, 0.81F, 0.79F, 0.81F});
  const SurfaceArc arc = even_arc(texture, 0, 1e6);
  const ArcSignal signal(arc, kEps, kTolerance_s);
  const ArcSample from = signal.at(kFrom_s);
  ArcSample first = signal.at(kFrom_s + kLength_s);
  ArcSample last = from;
  const ArcSample to = first;
  for (int depth = 0; depth < 20; ++depth) {
    first = signal.divide(from, first, depth);
    last = signal.divide(last, to, depth);
  }
  EXPECT_LT(first.t_s - from.t_s, kTolerance_s);
  EXPECT_LT(to.t_s - last.t_s, kTolerance_s);
}

TEST(SurfaceArc, WholeLevelsOfFilteredTexturesAreBorders) {
  const Texture texture = columns({0.F, 1.F, 0.F, 1.F, 0.F, 1.F, 0.F, 1.F});
  const SurfaceArc arc(kFrom_s, kFrom_s + kLength_s, seen_at(&texture, 3, 3, 1, 0.8),
                       seen_at(&texture, 3, 3, 1, 1.3), seen_at(&texture, 3, 3, 1, 1.8));
  const double end_s = kFrom_s + kLength_s;
  const double one_s = kFrom_s + 0.2 * kLength_s;
  EXPECT_NEAR(arc.next_border_s(kFrom_s, end_s), one_s, 1e-12);
  EXPECT_EQ(arc.next_border_s(one_s, end_s), end_s);
}

}  // namespace
}  // namespace saccade
