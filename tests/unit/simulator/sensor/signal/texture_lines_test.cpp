#include "simulator/sensor/signal/texture_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/meshes.h"

namespace saccade {
namespace {

constexpr double kLogEps = 0.01;
constexpr LineLimits kLimits{1e-3, 0.05};
constexpr double kLeast = 1e-6;

/// Curved, through eight columns and back over four rows.
TexelTrajectory slanting_path() {
  return {{3.2, 8.8, 7.5, 8.4, 11.6, 8}, {8.3, -4.4, 6.15, -4.2, 4.1, -4}, 2.0, 0.01};
}

class Scan {
 public:
  Scan(const Texture& texture, double factor)
      : path_(slanting_path()),
        texture_(texture),
        factor_(factor),
        cells_(texture, TexelBorders(path_.x), TexelBorders(path_.y)) {}

  [[nodiscard]] const PathCells& cells() const { return cells_; }
  [[nodiscard]] TextureLines lines(double u) const {
    return {path_, cells_, factor_, kLogEps, kLimits, u};
  }
  [[nodiscard]] double radiance(double u) const {
    return factor_ * texture_.at_texel(path_.x.at(u), path_.y.at(u));
  }
  [[nodiscard]] double log_intensity(double u) const { return std::log(kLogEps + radiance(u)); }
  [[nodiscard]] std::vector<double> ends(double from, double to) const {
    std::vector<double> ends{from};
    for (TextureLines walk = lines(from); walk.u() < to && ends.size() < 10000;) {
      walk.advance(to, kLeast);
      ends.push_back(walk.u());
    }
    return ends;
  }

 private:
  TexelTrajectory path_;
  const Texture& texture_;
  double factor_;
  PathCells cells_;
};

// Every instant of the path is in one cell, which has the texels of the texture there.
TEST(PathCells, AreThoseOfTheTextureInOrder) {
  const Texture texture(testing::patches(16, 12, 5));
  const Scan scan(texture, 1);
  const PathCells& cells = scan.cells();
  ASSERT_EQ(cells.count(), 8 + 4 + 1);
  EXPECT_EQ(cells.start(), 0);
  double start = 0;
  for (int k = 0; k < cells.count(); ++k) {
    const double u = 0.5 * (start + cells.end(k));
    EXPECT_GE(cells.end(k), start);
    EXPECT_EQ(cells.i(k), static_cast<std::int64_t>(std::floor(slanting_path().x.at(u)))) << k;
    EXPECT_EQ(cells.j(k), static_cast<std::int64_t>(std::floor(slanting_path().y.at(u)))) << k;
    EXPECT_EQ(cells.corners(k), texture.cell(cells.i(k), cells.j(k)));
    EXPECT_EQ(cells.at(u), k);
    start = cells.end(k);
  }
  EXPECT_EQ(start, 1);
}

TEST(PathCells, AreNoneWhereThePathTurns) {
  const Texture texture(testing::patches(16, 12, 5));
  const TrajectoryCoordinate turning(5.3, -4, 4.3, 0.1, 5.4, 4.2);
  EXPECT_EQ(PathCells(texture, TexelBorders(slanting_path().x), TexelBorders(turning)).count(), 0);
}

TEST(TextureLines, StayWithinTheLimits) {
  const Texture texture(testing::patches(16, 12, 5));
  const Scan scan(texture, 0.7);
  for (const double from : {0.0, 0.4321}) {
    const double to = 0.87;
    const std::vector<double> ends = scan.ends(from, to);
    ASSERT_EQ(ends.back(), to);
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const double a = scan.log_intensity(ends[k - 1]);
      const double b = scan.log_intensity(ends[k]);
      EXPECT_LE(std::abs(b - a), kLimits.change) << k;
      for (double f = 0.05; f < 1; f += 0.05)
        EXPECT_NEAR(scan.log_intensity(std::lerp(ends[k - 1], ends[k], f)), std::lerp(a, b, f),
                    kLimits.error)
            << k << " " << f;
    }
  }
}

// Where a path crosses a border is known to a part of a texel alone: beyond it the texels of a cell
// that ends in black would give less than nothing, whose logarithm is none.
TEST(TextureLines, HaveNoRadianceBelowTheTexels) {
  ImageF checks(16, 12);
  for (int y = 0; y < checks.height(); ++y)
    for (int x = 0; x < checks.width(); ++x) checks(x, y) = (x + y) % 2 == 0 ? 1.0F : 0.0F;
  const Texture texture(checks);
  for (int k = 0; k < 200; ++k) {
    // Paths that are as even as those whose crossings are not searched for.
    const double bend = 0.2 * std::sin(k);
    const TexelTrajectory path{{3.2 + 0.01 * k, 8.2, 7.3 + 0.01 * k, 8.2, 11.4 + 0.01 * k, 8.2},
                               {8.3, -4.2 + bend, 6.2, -4.2, 4.1, -4.2 - bend},
                               2.0,
                               0.01};
    const PathCells cells(texture, TexelBorders(path.x), TexelBorders(path.y));
    TextureLines lines(path, cells, 1000, 1e-9, kLimits, 0);
    EXPECT_GE(lines.run_within({-1, 2000}, 1).least, 0);
    for (int n = 0; n < 100000 && lines.u() < 1; ++n) {
      lines.advance(1, kLeast);
      ASSERT_GE(lines.radiance(), 0) << k;
      ASSERT_LE(lines.radiance(), 1000) << k;
    }
  }
}

// One line goes as far over a smooth texture as its change allows.
TEST(TextureLines, GoOverManyCellsOfASmoothTexture) {
  ImageF ramp(16, 12);
  for (int y = 0; y < ramp.height(); ++y)
    for (int x = 0; x < ramp.width(); ++x) ramp(x, y) = 0.5F + 0.005F * static_cast<float>(x);
  const Texture texture(ramp);
  const Scan scan(texture, 1);
  const double whole = scan.log_intensity(1) - scan.log_intensity(0);
  EXPECT_EQ(static_cast<double>(scan.ends(0, 1).size() - 1), std::ceil(whole / kLimits.change));
}

TEST(TextureLines, KnowHowLongTheTextureStaysWithinABand) {
  const Texture texture(testing::patches(16, 12, 5));
  const Scan scan(texture, 0.7);
  int within_a_cell = 0;
  for (const double from : {0.0, 0.1, 0.25, 0.5})
    for (const double half : {0.01, 0.03, 0.15}) {
      const double middle = scan.radiance(from);
      const Interval band{middle - half, middle + half};
      const TextureLines::Run run = scan.lines(from).run_within(band, 0.9);
      EXPECT_GT(run.end, from);
      EXPECT_LE(run.end, 0.9);
      for (double u = from; u <= run.end; u += 1e-3) {
        EXPECT_GT(scan.radiance(u), band.low) << u;
        EXPECT_LT(scan.radiance(u), band.high) << u;
        EXPECT_GE(scan.radiance(u), run.least) << u;
      }
      // It goes to where the radiance leaves the band, but for the path's bending.
      if (run.end >= 0.9) continue;
      ++within_a_cell;
      const double beyond = scan.radiance(run.end + 0.01);
      EXPECT_TRUE(beyond <= band.low || beyond >= band.high) << from << " " << half;
    }
  EXPECT_GE(within_a_cell, 6);
  const Interval nowhere{2, 3};
  EXPECT_EQ(scan.lines(0.1).run_within(nowhere, 0.9).end, 0.1);
}

}  // namespace
}  // namespace saccade
