#include "estimator/depth/thesis/epipolar_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

constexpr int kRadius = 5;

/// Blobs and a slanted edge, smooth, moved by `shift`, with another gain and offset.
ImageF scene(const Eigen::Vector2d& shift, double gain = 1, double offset = 0) {
  ImageF image(64, 48);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double u = x - shift.x();
      const double v = y - shift.y();
      const double value = std::exp(-((u - 30) * (u - 30) + (v - 22) * (v - 22)) / 12) +
                           0.7 * std::exp(-std::pow((u + 0.4 * v - 43) / 2.5, 2));
      image(x, y) = static_cast<float>(offset + gain * value);
    }
  return image;
}

const Eigen::Vector2d kCentre(31.3, 23.6);

TEST(FramePatch, HasZeroMeanUnitNormAndItsDerivatives) {
  const ImageF image = scene({0, 0});
  const FramePatch patch(image, kCentre, kRadius);
  EXPECT_NEAR(patch.values().mean(), 0, 1e-6);
  EXPECT_NEAR(patch.values().norm(), 1, 1e-5);
  // Against central differences of the patch itself; the normalisation changes at second order.
  for (const Eigen::Vector2d& axis : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)}) {
    const double step = 1;
    const FramePatch forward(image, kCentre + step * axis, kRadius);
    const FramePatch backward(image, kCentre - step * axis, kRadius);
    Eigen::VectorXf numeric = (forward.values() - backward.values()) / static_cast<float>(2 * step);
    Eigen::VectorXf analytic = axis.x() > 0 ? patch.dx() : patch.dy();
    // What changes norm alone is taken out by the normalisation.
    analytic -= analytic.dot(patch.values()) * patch.values();
    EXPECT_LT((numeric - analytic).norm(), 0.1F * analytic.norm());
  }
}

TEST(FramePatch, FitsWithOnePixelAround) {
  const ImageF image(20, 20);
  EXPECT_TRUE(FramePatch::fits(image, {6, 6}, kRadius));
  EXPECT_FALSE(FramePatch::fits(image, {5.9, 6}, kRadius));
  EXPECT_TRUE(FramePatch::fits(image, {12.9, 12.9}, kRadius));
  EXPECT_FALSE(FramePatch::fits(image, {13, 10}, kRadius));
}

TEST(EpipolarSearch, FindsTheShiftAlongTheLine) {
  const FramePatch reference(scene({0, 0}), kCentre, kRadius);
  for (const double angle : {0.0, 0.7, 2.0, 4.0})
    for (const double shift : {-2.0, -0.6, 0.0, 0.3, 1.7}) {
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const ImageF frame = scene(shift * direction, 0.4, 2);
      const SearchResult result = search_along(reference, frame, kCentre, direction, {});
      EXPECT_EQ(result.status, SearchStatus::kFound);
      EXPECT_NEAR(result.shift_px, shift, 0.05) << angle;
      EXPECT_GT(result.correlation, 0.99);
    }
}

TEST(EpipolarSearch, RefusesALineAlongTheEdge) {
  ImageF image(40, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      image(x, y) = static_cast<float>(std::exp(-std::pow((x - 20) / 2.0, 2)));
  const FramePatch reference(image, {20, 20}, kRadius);
  EXPECT_EQ(search_along(reference, image, {20, 20}, {0, 1}, {}).status, SearchStatus::kNoGradient);
  EXPECT_EQ(search_along(reference, image, {20, 20}, {1, 0}, {}).status, SearchStatus::kFound);
}

TEST(EpipolarSearch, SaysWhyItFailed) {
  const ImageF image = scene({0, 0});
  const FramePatch reference(image, kCentre, kRadius);
  EXPECT_EQ(search_along(reference, image, {2, 20}, {1, 0}, {}).status, SearchStatus::kOutside);
  EXPECT_EQ(search_along(reference, scene({4, 0}), kCentre, {1, 0}, {.max_shift_px = 1}).status,
            SearchStatus::kDiverged);
  EXPECT_EQ(search_along(reference, ImageF(64, 48), kCentre, {1, 0}, {}).status,
            SearchStatus::kDifferent);
  const FramePatch flat(ImageF(64, 48), kCentre, kRadius);
  EXPECT_EQ(search_along(flat, image, kCentre, {1, 0}, {}).status, SearchStatus::kNoGradient);
}

}  // namespace
}  // namespace saccade
