#include "estimator/reconstruction/equations/coarse_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/random.h"

namespace saccade {
namespace {

std::vector<float> random_image(std::size_t pixels, std::uint64_t stream) {
  const Random random(11);
  std::vector<float> image;
  for (std::size_t i = 0; i < pixels; ++i)
    image.push_back(static_cast<float>(random.uniform(stream, i)) - 0.5F);
  return image;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum;
}

TEST(CoarseGrid, InterpolatesLinearImagesExactly) {
  for (const bool wraps : {false, true}) {
    const CoarseGrid grid(37, 22, wraps);
    Eigen::VectorXd nodes = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(grid.nodes()), 2);
    std::vector<float> image(37 * 22, 0);
    grid.interpolate(nodes, image);
    for (const float value : image) EXPECT_NEAR(value, 2, 1e-6);
    // Down the rows, which never wrap.
    for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
      const auto corners = grid.nodes_of(cell);
      const double row = std::floor(static_cast<double>(cell) / std::ceil((wraps ? 37 : 36) / 4.0));
      nodes[corners[0]] = nodes[corners[1]] = row * grid.cell_px().y();
      nodes[corners[2]] = nodes[corners[3]] = (row + 1) * grid.cell_px().y();
    }
    image.assign(image.size(), 0);
    grid.interpolate(nodes, image);
    for (int y = 0; y < 22; ++y)
      EXPECT_NEAR(image[static_cast<std::size_t>(y * 37 + 5)], y, 1e-4) << y;
  }
}

TEST(CoarseGrid, HasNoMoreCellsThanAreSolvedSoon) {
  EXPECT_EQ(CoarseGrid(241, 181, false).cells(), 60U * 45U);
  const CoarseGrid sphere(4000, 2000, true);
  EXPECT_LE(sphere.cells(), 101'000U);
  EXPECT_GT(sphere.cells(), 90'000U);
}

TEST(CoarseGrid, RestrictsByTheTransposeOfInterpolating) {
  for (const bool wraps : {false, true}) {
    const CoarseGrid grid(37, 22, wraps);
    const std::vector<float> image = random_image(37 * 22, 1);
    const std::vector<float> values = random_image(grid.nodes(), 2);
    const Eigen::VectorXd nodes =
        Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()))
            .cast<double>();
    std::vector<float> interpolated(image.size(), 0);
    grid.interpolate(nodes, interpolated);
    EXPECT_NEAR(grid.restricted(image).dot(nodes), dot(image, interpolated), 1e-3);
  }
}

/// What is pulled up along one side and down along the other slopes evenly: N cells of stiffness m and a slope g cost N m
/// g^2 / 2, and the pull of H pixels over a length of L gains H g L.
TEST(CoarseImage, SlopesAsItsStiffnessSays) {
  constexpr int kWidth = 41, kHeight = 9;
  const CoarseGrid grid(kWidth, kHeight, false);
  constexpr float kStiffness = 50;
  const std::vector<Stiffness> stiffness(grid.cells(), {kStiffness, 0, 10 * kStiffness});
  const CoarseImage coarse(grid, stiffness);
  std::vector<float> pull(kWidth * kHeight, 0), image(pull.size(), 0);
  for (std::size_t y = 0; y < kHeight; ++y) {
    // So that all nodes of a side get the same.
    const float share = y == 0 || y + 1 == kHeight ? 0.5F : 1;
    pull[y * kWidth] = -share;
    pull[y * kWidth + kWidth - 1] = share;
  }
  coarse.add(pull, image);
  const double slope = (kHeight - 1.0) * (kWidth - 1) /
                       (static_cast<double>(grid.cells()) * static_cast<double>(kStiffness));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      EXPECT_NEAR(image[static_cast<std::size_t>(y * kWidth + x)], slope * (x - 20), 0.01 * slope)
          << x << " " << y;
}

/// Along the direction that nothing constrains an image is free.
TEST(CoarseImage, FollowsATensorThatIsTurned) {
  const CoarseGrid grid(33, 33, false);
  const std::vector<Stiffness> stiffness(grid.cells(), {1, 0.99F, 1});
  const CoarseImage coarse(grid, stiffness);
  const auto response = [&](float along_x, float along_y) {
    std::vector<float> pull(33 * 33, 0), image(pull.size(), 0);
    for (std::size_t y = 0; y < 33; ++y)
      for (std::size_t x = 0; x < 33; ++x)
        pull[y * 33 + x] =
            along_x * (static_cast<float>(x) - 16) + along_y * (static_cast<float>(y) - 16);
    coarse.add(pull, image);
    return dot(pull, image);
  };
  EXPECT_GT(response(1, -1), 20 * response(1, 1));
}

/// The same pull everywhere lifts the image by itself over the weight, whatever slopes cost.
TEST(CoarseImage, LevelsCostTheirWeight) {
  for (const bool wraps : {false, true}) {
    const CoarseGrid grid(33, 25, wraps);
    const std::vector<Stiffness> stiffness(grid.cells(), {100, 0, 100});
    const CoarseImage coarse(grid, stiffness, 4);
    std::vector<float> pull(33 * 25, 1), image(pull.size(), 0);
    // Nodes at the borders have half the area of the cells, but the whole pull of their pixels.
    for (std::size_t i = 0; i < pull.size(); ++i) {
      const bool is_side = !wraps && (i % 33 == 0 || i % 33 == 32);
      const bool is_end = i / 33 == 0 || i / 33 == 24;
      pull[i] = (is_side ? 0.5F : 1.0F) * (is_end ? 0.5F : 1.0F);
    }
    coarse.add(pull, image);
    for (const float value : image) EXPECT_NEAR(value, 0.25, 0.008);
  }
}

TEST(CoarseImage, AddsNothingWhereTheStiffnessIsNotFinite) {
  const CoarseGrid grid(9, 9, false);
  std::vector<Stiffness> stiffness(grid.cells(), {1, 0, 1});
  stiffness[1].xx = std::numeric_limits<float>::quiet_NaN();
  const CoarseImage coarse(grid, stiffness);
  const std::vector<float> pull = random_image(81, 3);
  std::vector<float> image(81, 1);
  coarse.add(pull, image);
  for (const float value : image) EXPECT_EQ(value, 1);
}

}  // namespace
}  // namespace saccade
