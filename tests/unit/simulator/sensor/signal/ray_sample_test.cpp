#include "simulator/sensor/signal/ray_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

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
RayView random_view(const Texture& texture, double speed, std::uint64_t stream,
                    std::uint64_t index) {
  const auto draw = [&](std::uint64_t k) { return kRandom.uniform(stream, 8 * index + k); };
  return {7,
          {&texture, 40 * draw(0) - 8, 30 * draw(1) - 6, 0.5 + draw(2), 1, 2},
          speed * (2 * draw(3) - 1),
          speed * (2 * draw(4) - 1)};
}

/// The other end of a nearly even motion over `length_s`.
RayView later(const RayView& from, double length_s, std::uint64_t index) {
  const auto change = [&](std::uint64_t k) {
    return 40 * (kRandom.uniform(5, 8 * index + k) - 0.5);
  };
  RayView to = from;
  to.x_rate += change(0);
  to.y_rate += change(1);
  to.look.x += length_s * 0.5 * (from.x_rate + to.x_rate);
  to.look.y += length_s * 0.5 * (from.y_rate + to.y_rate);
  return to;
}

TEST(RayView, CubicHasItsEnds) {
  const Texture texture = noise_texture();
  const RayView from = random_view(texture, 100, 1, 0);
  const RayView to = later(from, 0.01, 0);
  for (const auto& [u, end] : {std::pair(0.0, from), std::pair(1.0, to)}) {
    const RayView view = interpolate(from, to, 0.01, u);
    EXPECT_NEAR(view.look.x, end.look.x, 1e-12);
    EXPECT_NEAR(view.look.y, end.look.y, 1e-12);
    EXPECT_NEAR(view.x_rate, end.x_rate, 1e-9);
    EXPECT_NEAR(view.y_rate, end.y_rate, 1e-9);
  }
  const double h = 1e-6;
  const double slope =
      (interpolate(from, to, 0.01, 0.3 + h).look.x - interpolate(from, to, 0.01, 0.3 - h).look.x) /
      (2 * h * 0.01);
  EXPECT_NEAR(interpolate(from, to, 0.01, 0.3).x_rate, slope, 1e-5);
}

// Whatever the length of the stretch, its bounds hold the radiance and its rate at every time.
TEST(RayView, RangeBoundsTheRadianceAlongThePath) {
  const Texture texture = noise_texture();
  int bounded_rates = 0;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const double length_s = 1e-5 + 0.02 * std::pow(kRandom.uniform(2, k), 3);
    const RayView from = random_view(texture, 400, 3, k);
    const RayView to = later(from, length_s, k);
    const RadianceRange range = radiance_range(from, to, length_s);
    const bool has_rates = std::isfinite(range.rate_low);
    bounded_rates += has_rates ? 1 : 0;
    for (double u = 0; u <= 1; u += 0.05) {
      const RayView view = interpolate(from, to, length_s, u);
      ASSERT_GE(view.look.radiance(), range.low - 1e-3);
      ASSERT_LE(view.look.radiance(), range.high + 1e-3);
      // Within a thousandth of a texel behind its border the path still counts as in the cell.
      const bool is_in_cell =
          std::floor(view.look.x) == std::floor(0.5 * (from.look.x + to.look.x)) &&
          std::floor(view.look.y) == std::floor(0.5 * (from.look.y + to.look.y));
      if (!has_rates || !is_in_cell || u + 1e-4 > 1) continue;
      const double rate =
          (interpolate(from, to, length_s, u + 1e-4).look.radiance() - view.look.radiance()) /
          (1e-4 * length_s);
      const double slack = 0.01 * std::max(std::abs(range.rate_low), std::abs(range.rate_high)) + 5;
      ASSERT_GE(rate, range.rate_low - slack);
      ASSERT_LE(rate, range.rate_high + slack);
    }
  }
  EXPECT_GT(bounded_rates, 300);
}

TEST(RayView, BoundsOfTheRateShrinkWithTheStretch) {
  const Texture texture = noise_texture();
  const RayView from{7, {&texture, 5.3, 4.4, 1, 1, 2}, 100, 30};
  for (const double length_s : {1e-3, 1e-5}) {
    RayView to = from;
    to.look.x += 100 * length_s;
    to.look.y += 30 * length_s;
    const RadianceRange range = radiance_range(from, to, length_s);
    const double change = (to.look.radiance() - from.look.radiance()) / length_s;
    EXPECT_NEAR(range.rate_low, change, 500 * length_s * 100);
    EXPECT_NEAR(range.rate_high, change, 500 * length_s * 100);
  }
}

TEST(RayView, DivisionLeavesTheCell) {
  const Texture texture = noise_texture();
  const RayView from{7, {&texture, 5.3, 4.4, 1, 1, 2}, 100, 0};
  RayView to = from;
  to.look.x = 6.3;
  const double u = dividing_fraction(from, to, 0.01);
  EXPECT_NEAR(interpolate(from, to, 0.01, u).look.x, 6, 1e-4);
  EXPECT_TRUE(
      std::isfinite(radiance_range(from, interpolate(from, to, 0.01, u), u * 0.01).rate_low));
}

TEST(RayView, DifferentTexturesHaveNoBounds) {
  const Texture one = noise_texture();
  const Texture other = noise_texture();
  const RayView from = random_view(one, 10, 1, 3);
  RayView to = from;
  to.look.texture = &other;
  EXPECT_EQ(radiance_range(from, to, 0.01).high, RadianceRange::kUnknown);
}

}  // namespace
}  // namespace saccade
