#include "estimator/reconstruction/equations/intensity_system.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "estimator/reconstruction/observations/reference_grid.h"

namespace saccade {
namespace {

constexpr int kWidth = 12, kHeight = 10;

std::vector<std::vector<GridObservation>> random_tracks(const ReferenceGrid& grid) {
  const Random random(3);
  std::uint64_t draw = 0;
  const auto uniform = [&] { return static_cast<float>(random.uniform(1, draw++)); };
  std::vector<std::vector<GridObservation>> runs(80);
  for (auto& run : runs)
    for (int k = 0; k < 6; ++k) {
      const float x = (kWidth - 1) * uniform(), y = (kHeight - 1) * uniform();
      run.push_back({x, y, grid.at(x, y), uniform(), 0.5F + uniform()});
    }
  return runs;
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
Eigen::VectorXd dense_solution(const std::vector<std::vector<GridObservation>>& runs) {
  const auto pixels = kWidth * kHeight;
  const auto size = pixels + static_cast<int>(runs.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (std::size_t t = 0; t < runs.size(); ++t)
    for (const GridObservation& observation : runs[t]) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
      for (std::size_t k = 0; k < 4; ++k)
        row[observation.point.index[k]] += static_cast<double>(observation.point.weight[k]);
      row[pixels + static_cast<int>(t)] = -1;
      a += static_cast<double>(observation.weight) * row * row.transpose();
      b += static_cast<double>(observation.weight * observation.log_intensity) * row;
    }
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x + 1 < kWidth; ++x) {
      const int i = y * kWidth + x;
      a(i, i) += 0.1;
      a(i + 1, i + 1) += 0.1;
      a(i, i + 1) -= 0.1;
      a(i + 1, i) -= 0.1;
    }
  a(0, 0) += 1;  // The constant that observations leave undetermined.
  return without_mean(a.ldlt().solve(b).head(pixels));
}

TEST(IntensitySystem, EqualsTheDenseProblemWithOffsets) {
  const ReferenceGrid grid(ImageF(kWidth, kHeight, 1.0F));
  const auto runs = random_tracks(grid);
  IntensitySystem system(kWidth, kHeight);
  for (const auto& run : runs) system.add_run(0, run);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x + 1 < kWidth; ++x)
      system.add_smoothness_term(y * kWidth + x + 1, y * kWidth + x, 0.1F);
  const GridSolution solution = system.solve(500, 1e-4);
  EXPECT_LE(solution.iterations, 20);
  const Eigen::VectorXd found = without_mean(solution.image), expected = dense_solution(runs);
  for (int i = 0; i < kWidth * kHeight; ++i) EXPECT_NEAR(found[i], expected[i], 2e-3) << i;
  // Started from its solution it has converged.
  EXPECT_LE(system.solve(500, 1e-3, solution.image).iterations, 3);
}

/// Observations that hardly count beside others of their run still lie where they do.
TEST(IntensitySystem, HoldsWeightsOfFourOrdersOfMagnitude) {
  const ReferenceGrid grid(ImageF(kWidth, kHeight, 1.0F));
  auto runs = random_tracks(grid);
  for (std::size_t t = 0; t < runs.size(); ++t)
    for (std::size_t k = 1; k < runs[t].size(); ++k)
      runs[t][k].weight *= k % 2 == t % 2 ? 1 : 1e-4F;
  IntensitySystem system(kWidth, kHeight);
  for (const auto& run : runs) system.add_run(0, run);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x + 1 < kWidth; ++x)
      system.add_smoothness_term(y * kWidth + x + 1, y * kWidth + x, 0.1F);
  const Eigen::VectorXd found = without_mean(system.solve(1000, 1e-4).image);
  const Eigen::VectorXd expected = dense_solution(runs);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 0.02);
}

/// Paths of pixels over a view of which one half moves a hundred times as often as the other.
TEST(IntensitySystem, UnevenObservationsTakeFewIterations) {
  constexpr int kSize = 96;
  const ReferenceGrid grid(ImageF(kSize, kSize, 1.0F));
  const Random random(7);
  const auto solve = [&](std::size_t parts) {
    IntensitySystem system(kSize, kSize, false, parts);
    std::uint64_t draw = 0;
    const auto uniform = [&] { return static_cast<float>(random.uniform(2, draw++)); };
    for (std::size_t t = 0; t < 20'000; ++t) {
      const bool is_dense = t % 100 != 0, is_along_x = t % 2 == 0;
      const float x = (is_dense ? 0.5F : 0) * kSize + 0.3F * kSize * uniform();
      const float y = (kSize - 13) * uniform();
      std::vector<GridObservation> run;
      for (int k = 0; k < 12; ++k) {
        const float u = x + static_cast<float>(is_along_x ? k : 0);
        const float v = y + static_cast<float>(is_along_x ? 0 : k);
        run.push_back({u, v, grid.at(u, v), std::sin(0.05F * u) + 0.1F * uniform(), 100});
      }
      system.add_run(t % parts, run);
    }
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const int i = y * kSize + x;
        if (x + 1 < kSize) system.add_smoothness_term(i, i + 1, 25);
        if (y + 1 < kSize) system.add_smoothness_term(i, i + kSize, 25);
      }
    return system.solve(400, 1e-4);
  };
  const GridSolution whole = solve(1), divided = solve(5);
  EXPECT_LE(whole.iterations, 30);
  EXPECT_LE(whole.residual, 1e-4);
  // Who adds a run makes no difference.
  const Eigen::VectorXd difference = without_mean(whole.image) - without_mean(divided.image);
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 2e-3);
  // The wave that is seen, where it is seen.
  EXPECT_NEAR(whole.image(80, 50) - whole.image(55, 50), std::sin(4.0F) - std::sin(2.75F), 0.03F);
}

/// Two halves of a view that nothing joins: each is seen but for a constant, which the level weight keeps at 0.
TEST(IntensitySystem, LevelsOfPartsThatNothingComparesStayAtTheMean) {
  const ReferenceGrid grid(ImageF(kWidth, kHeight, 1.0F));
  const Random random(9);
  std::uint64_t draw = 0;
  const auto uniform = [&] { return static_cast<float>(random.uniform(3, draw++)); };
  IntensitySystem system(kWidth, kHeight);
  for (int t = 0; t < 400; ++t) {
    std::vector<GridObservation> run;
    const float left = t % 2 == 0 ? 0 : kWidth / 2, offset = 5 * uniform();
    for (int k = 0; k < 6; ++k) {
      const float x = left + (kWidth / 2 - 1) * uniform(), y = (kHeight - 1) * uniform();
      run.push_back({x, y, grid.at(x, y), std::sin(x) + offset, 100});
    }
    system.add_run(0, run);
  }
  const auto means = [&](float weight) {
    system.set_level_weight(weight);
    ImageF far_apart(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) far_apart(x, y) = x < kWidth / 2 ? -3.0F : 2.0F;
    const ImageF image = system.solve(500, 1e-4, far_apart).image;
    Eigen::Vector2d sums(0, 0);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        sums[x < kWidth / 2 ? 0 : 1] += static_cast<double>(image(x, y));
    return Eigen::Vector2d(sums / (kWidth * kHeight / 2));
  };
  const Eigen::Vector2d free = means(0), held = means(0.1F);
  EXPECT_GT((free - held).norm(), 0.3);
  EXPECT_NEAR(held[0], 0, 0.02);
  EXPECT_NEAR(held[1], 0, 0.02);
}

/// Where the columns of an image that goes around begin makes no difference.
TEST(IntensitySystem, HasNoSeamWhereItWraps) {
  const ReferenceGrid grid(Panorama{kWidth, 0, 0, kWidth, kWidth / 2});
  const Random random(5);
  const auto solve = [&](int shift) {
    IntensitySystem system(grid.width(), grid.height(), true);
    std::uint64_t draw = 0;
    const auto uniform = [&] { return static_cast<float>(random.uniform(1, draw++)); };
    for (int t = 0; t < 60; ++t) {
      std::vector<GridObservation> run;
      for (int k = 0; k < 6; ++k) {
        const float x = kWidth * uniform() + static_cast<float>(shift);
        const float y = (kWidth / 2 - 1) * uniform();
        const float observation = uniform();
        run.push_back({x, y, grid.at(x, y), observation, 0.5F + uniform()});
      }
      system.add_run(0, run);
    }
    for (int y = 0; y < grid.height(); ++y)
      for (int x = 0; x < grid.width(); ++x) {
        system.add_smoothness_term(y * kWidth + x, grid.right_of(x, y), 0.2F);
        if (y + 1 < grid.height())
          system.add_smoothness_term(y * kWidth + x, grid.below(x, y), 0.2F);
      }
    return without_mean(system.solve(400, 1e-4).image);
  };
  const Eigen::VectorXd plain = solve(0), shifted = solve(5), turned = solve(kWidth);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const int row = y * kWidth;
      EXPECT_NEAR(shifted[row + (x + 5) % kWidth], plain[row + x], 2e-3) << x << " " << y;
      EXPECT_NEAR(turned[row + x], plain[row + x], 2e-3) << x << " " << y;
    }
}

}  // namespace
}  // namespace saccade
