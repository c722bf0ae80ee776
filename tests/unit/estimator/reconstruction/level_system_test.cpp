#include "estimator/reconstruction/level_system.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "estimator/reconstruction/reference_grid.h"

namespace saccade {
namespace {

constexpr int kWidth = 12, kHeight = 10;

std::vector<std::vector<GridLevel>> random_tracks(const ReferenceGrid& grid) {
  const Random random(3);
  std::uint64_t draw = 0;
  const auto uniform = [&] { return static_cast<float>(random.uniform(1, draw++)); };
  std::vector<std::vector<GridLevel>> tracks(80);
  for (auto& track : tracks)
    for (int k = 0; k < 6; ++k)
      track.push_back({grid.at((kWidth - 1) * uniform(), (kHeight - 1) * uniform()), uniform(),
                       0.5F + uniform()});
  return tracks;
}

Eigen::VectorXd without_mean(const Eigen::VectorXd& values) {
  return values.array() - values.mean();
}

Eigen::VectorXd without_mean(const ImageF& image) {
  return without_mean(Eigen::VectorXd(
      Eigen::Map<const Eigen::VectorXf>(image.data(), static_cast<Eigen::Index>(image.size()))
          .cast<double>()));
}

/// The same least-squares problem with image and offsets as dense unknowns.
Eigen::VectorXd dense_solution(const std::vector<std::vector<GridLevel>>& tracks) {
  const auto pixels = kWidth * kHeight;
  const auto size = pixels + static_cast<int>(tracks.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (std::size_t t = 0; t < tracks.size(); ++t)
    for (const GridLevel& level : tracks[t]) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
      for (std::size_t k = 0; k < 4; ++k)
        row[level.place.index[k]] += static_cast<double>(level.place.weight[k]);
      row[pixels + static_cast<int>(t)] = -1;
      a += static_cast<double>(level.weight) * row * row.transpose();
      b += static_cast<double>(level.weight * level.level) * row;
    }
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x + 1 < kWidth; ++x) {
      const int i = y * kWidth + x;
      a(i, i) += 0.1;
      a(i + 1, i + 1) += 0.1;
      a(i, i + 1) -= 0.1;
      a(i + 1, i) -= 0.1;
    }
  a(0, 0) += 1;  // The constant that levels leave open.
  return without_mean(a.ldlt().solve(b).head(pixels));
}

TEST(LevelSystem, EqualsTheDenseProblemWithOffsets) {
  const ReferenceGrid grid(ImageF(kWidth, kHeight, 1.0F), 1, 0.05);
  const auto tracks = random_tracks(grid);
  LevelSystem system(kWidth, kHeight);
  for (const auto& track : tracks) system.add_track(track);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x + 1 < kWidth; ++x)
      system.add_smooth(y * kWidth + x + 1, y * kWidth + x, 0.1F);
  const GridSolution solution = system.solve(500, 1e-6);
  const Eigen::VectorXd found = without_mean(solution.image), expected = dense_solution(tracks);
  for (int i = 0; i < kWidth * kHeight; ++i) EXPECT_NEAR(found[i], expected[i], 2e-3) << i;
  // From its own solution there is nothing left to do.
  EXPECT_LE(system.solve(500, 1e-4, solution.image).iterations, 3);
}

/// Where the columns of an image that goes around begin makes no difference.
TEST(LevelSystem, HasNoSeamWhereItWraps) {
  const ReferenceGrid grid(Panorama{kWidth, 0, 0, kWidth, kWidth / 2});
  const Random random(5);
  const auto solve = [&](int shift) {
    LevelSystem system(grid.width(), grid.height(), true);
    std::uint64_t draw = 0;
    const auto uniform = [&] { return static_cast<float>(random.uniform(1, draw++)); };
    for (int t = 0; t < 60; ++t) {
      std::vector<GridLevel> track;
      for (int k = 0; k < 6; ++k) {
        const float x = kWidth * uniform() + static_cast<float>(shift);
        const float y = (kWidth / 2 - 1) * uniform();
        const float level = uniform();
        track.push_back({grid.at(x, y), level, 0.5F + uniform()});
      }
      system.add_track(track);
    }
    for (int y = 0; y < grid.height(); ++y)
      for (int x = 0; x < grid.width(); ++x) {
        system.add_smooth(y * kWidth + x, grid.right_of(x, y), 0.2F);
        if (y + 1 < grid.height()) system.add_smooth(y * kWidth + x, grid.below(x, y), 0.2F);
      }
    return without_mean(system.solve(400, 1e-7).image);
  };
  const Eigen::VectorXd plain = solve(0), shifted = solve(5), turned = solve(kWidth);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const int row = y * kWidth;
      EXPECT_NEAR(shifted[row + (x + 5) % kWidth], plain[row + x], 2e-3) << x << " " << y;
      EXPECT_NEAR(turned[row + x], plain[row + x], 2e-3) << x << " " << y;
    }
}

TEST(ReferenceGrid, GoesAroundWhereAPanoramaWraps) {
  const ReferenceGrid grid(Panorama::sphere(40));
  for (const float x : {39.25F, -0.75F, 79.25F}) {
    const GridPoint point = grid.at(x, 3);
    EXPECT_EQ(point.index[0] % 40, 39);
    EXPECT_EQ(point.index[1] % 40, 0);
    EXPECT_NEAR(point.weight[1] + point.weight[3], 0.25F, 1e-4F);
  }
  EXPECT_EQ(grid.nearest(39.75F, 2), 80U);
  EXPECT_EQ(grid.right_of(39, 2), 80);
  EXPECT_EQ(ReferenceGrid(Panorama{40, 3, 0, 30, 20}).right_of(29, 2), -1);
}

TEST(ReferenceGrid, DoesNotMixSurfaces) {
  ImageF inverse_depth(4, 4, 1.0F);
  for (int y = 0; y < 4; ++y)
    for (int x = 2; x < 4; ++x) inverse_depth(x, y) = 0.5F;
  const ReferenceGrid grid(inverse_depth, 1, 0.05);
  const GridPoint left = grid.at(1.4F, 1.0F);
  EXPECT_FLOAT_EQ(left.weight[0], 1);
  EXPECT_FLOAT_EQ(left.weight[1], 0);
  const GridPoint right = grid.at(1.6F, 1.0F);
  EXPECT_FLOAT_EQ(right.weight[0], 0);
  EXPECT_FLOAT_EQ(right.weight[1], 1);
  EXPECT_FALSE(grid.is_joined(1, 2));
}

}  // namespace
}  // namespace saccade
