#include "simulator/sensor/signal/ray_sample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

const Random kRandom(11);

Texture noise_texture() {
  ImageF image(24, 17);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = static_cast<float>(kRandom.uniform(0, i));
  return Texture(image);
}

/// A view at a random place, moving at up to `speed` texels per second.
RaySample random_view(const Texture& texture, double speed, std::uint64_t stream,
                      std::uint64_t index) {
  const auto draw = [&](std::uint64_t k) { return kRandom.uniform(stream, 8 * index + k); };
  return {7,
          {&texture, 40 * draw(0) - 8, 30 * draw(1) - 6, 0.5 + draw(2), 1, 2},
          speed * (2 * draw(3) - 1),
          speed * (2 * draw(4) - 1)};
}

/// The other end of a nearly even motion over `length_s`.
RaySample later(const RaySample& from, double length_s, std::uint64_t index) {
  const auto change = [&](std::uint64_t k) {
    return 40 * (kRandom.uniform(5, 8 * index + k) - 0.5);
  };
  RaySample to = from;
  to.x_rate += change(0);
  to.y_rate += change(1);
  to.surface.x += length_s * 0.5 * (from.x_rate + to.x_rate);
  to.surface.y += length_s * 0.5 * (from.y_rate + to.y_rate);
  return to;
}

TEST(RaySample, CubicHasItsEnds) {
  const Texture texture = noise_texture();
  const RaySample from = random_view(texture, 100, 1, 0);
  const RaySample to = later(from, 0.01, 0);
  for (const auto& [u, end] : {std::pair(0.0, from), std::pair(1.0, to)}) {
    const RaySample sample = interpolate(from, to, 0.01, u);
    EXPECT_NEAR(sample.surface.x, end.surface.x, 1e-12);
    EXPECT_NEAR(sample.surface.y, end.surface.y, 1e-12);
    EXPECT_NEAR(sample.x_rate, end.x_rate, 1e-9);
    EXPECT_NEAR(sample.y_rate, end.y_rate, 1e-9);
  }
  const double h = 1e-6;
  const double slope = (interpolate(from, to, 0.01, 0.3 + h).surface.x -
                        interpolate(from, to, 0.01, 0.3 - h).surface.x) /
                       (2 * h * 0.01);
  EXPECT_NEAR(interpolate(from, to, 0.01, 0.3).x_rate, slope, 1e-5);
}

// Whatever the length of the stretch, its bounds hold the radiance and its rate at every time.
TEST(RaySample, RangeBoundsTheRadianceAlongThePath) {
  const Texture texture = noise_texture();
  int bounded_rates = 0;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const double length_s = 1e-5 + 0.02 * std::pow(kRandom.uniform(2, k), 3);
    const RaySample from = random_view(texture, 400, 3, k);
    const RaySample to = later(from, length_s, k);
    const RadianceRange range = radiance_range(from, to, length_s);
    const bool has_rates = std::isfinite(range.rate_low);
    bounded_rates += has_rates ? 1 : 0;
    for (double u = 0; u <= 1; u += 0.05) {
      const RaySample sample = interpolate(from, to, length_s, u);
      ASSERT_GE(sample.surface.radiance(), range.low - 1e-3);
      ASSERT_LE(sample.surface.radiance(), range.high + 1e-3);
      // Within a thousandth of a texel behind its border the path still counts as in the cell.
      const bool is_in_cell =
          std::floor(sample.surface.x) == std::floor(0.5 * (from.surface.x + to.surface.x)) &&
          std::floor(sample.surface.y) == std::floor(0.5 * (from.surface.y + to.surface.y));
      if (!has_rates || !is_in_cell || u + 1e-4 > 1) continue;
      const double rate = (interpolate(from, to, length_s, u + 1e-4).surface.radiance() -
                           sample.surface.radiance()) /
                          (1e-4 * length_s);
      const double slack = 0.01 * std::max(std::abs(range.rate_low), std::abs(range.rate_high)) + 5;
      ASSERT_GE(rate, range.rate_low - slack);
      ASSERT_LE(rate, range.rate_high + slack);
    }
  }
  EXPECT_GT(bounded_rates, 300);
}

TEST(RaySample, BoundsOfTheRateShrinkWithTheStretch) {
  const Texture texture = noise_texture();
  const RaySample from{7, {&texture, 5.3, 4.4, 1, 1, 2}, 100, 30};
  for (const double length_s : {1e-3, 1e-5}) {
    RaySample to = from;
    to.surface.x += 100 * length_s;
    to.surface.y += 30 * length_s;
    const RadianceRange range = radiance_range(from, to, length_s);
    const double change = (to.surface.radiance() - from.surface.radiance()) / length_s;
    EXPECT_NEAR(range.rate_low, change, 500 * length_s * 100);
    EXPECT_NEAR(range.rate_high, change, 500 * length_s * 100);
  }
}

TEST(RaySample, DivisionLeavesTheCell) {
  const Texture texture = noise_texture();
  const RaySample from{7, {&texture, 5.3, 4.4, 1, 1, 2}, 100, 0};
  RaySample to = from;
  to.surface.x = 6.3;
  const double u = split_fraction(from, to, 0.01);
  EXPECT_NEAR(interpolate(from, to, 0.01, u).surface.x, 6, 1e-4);
  EXPECT_TRUE(
      std::isfinite(radiance_range(from, interpolate(from, to, 0.01, u), u * 0.01).rate_low));
}

TEST(RaySample, DifferentTexturesHaveNoBounds) {
  const Texture one = noise_texture();
  const Texture other = noise_texture();
  const RaySample from = random_view(one, 10, 1, 3);
  RaySample to = from;
  to.surface.texture = &other;
  EXPECT_EQ(radiance_range(from, to, 0.01).high, RadianceRange::kUnknown);
}

}  // namespace
}  // namespace saccade
