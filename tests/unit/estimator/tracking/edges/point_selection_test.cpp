#include "estimator/tracking/edges/point_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/estimator/tracking/edges/synthetic_template.h"

namespace saccade {
namespace {

using testing::small_camera;
using Kind = SelectionOptions::Kind;

std::vector<TemplatePoint> rectangles() {
  static const MapPoints map = testing::rectangle_map();
  TemplateDrawer drawer(small_camera(), {}, map);
  const std::span<const TemplatePoint> drawn = drawer.draw({});
  return {drawn.begin(), drawn.end()};
}

float gradient(const TemplatePoint& p) {
  return std::hypot(p.slope.x() / static_cast<float>(small_camera().fx),
                    p.slope.y() / static_cast<float>(small_camera().fy));
}

int column(const TemplatePoint& p) {
  return static_cast<int>(
      std::lround(static_cast<double>(p.ray.x()) * small_camera().fx + small_camera().cx));
}

int row(const TemplatePoint& p) {
  return static_cast<int>(
      std::lround(static_cast<double>(p.ray.y()) * small_camera().fy + small_camera().cy));
}

bool in_row_major_order(std::span<const TemplatePoint> points) {
  return std::is_sorted(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::pair(row(a), column(a)) < std::pair(row(b), column(b));
  });
}

SelectionOptions options_of(Kind kind) {
  SelectionOptions options;
  options.kind = kind;
  return options;
}

TEST(PointSelection, RandomAndDenseHaveEveryPointToChooseFrom) {
  const auto points = rectangles();
  for (const Kind kind : {Kind::kRandom, Kind::kDense}) {
    PointSelector selector(options_of(kind), small_camera());
    EXPECT_EQ(selector.select(points).data(), points.data());
    EXPECT_EQ(selector.select(points).size(), points.size());
  }
}

TEST(PointSelection, SemiDenseTakesTheSteepest) {
  const auto points = rectangles();
  for (const double share : {0.1, 0.3, 1.0}) {
    SelectionOptions options = options_of(Kind::kSemiDense);
    options.steepest_fraction = share;
    PointSelector selector(options, small_camera());
    const auto chosen = selector.select(points);
    EXPECT_NEAR(static_cast<double>(chosen.size()), share * static_cast<double>(points.size()), 2);
    EXPECT_TRUE(in_row_major_order(chosen));
    float weakest = 1e9F;
    for (const TemplatePoint& p : chosen) weakest = std::min(weakest, gradient(p));
    const auto stronger = std::count_if(points.begin(), points.end(), [&](const TemplatePoint& p) {
      return gradient(p) > 1.0001F * weakest;
    });
    EXPECT_LE(stronger, static_cast<std::ptrdiff_t>(chosen.size())) << "none of them was left out";
  }
}

TEST(PointSelection, PatchesSurroundTheSteepestPointOfEachCell) {
  const auto points = rectangles();
  SelectionOptions options = options_of(Kind::kSparsePatches);
  options.cell_px = 40;
  options.patch_px = 5;
  PointSelector selector(options, small_camera());
  const auto chosen = selector.select(points);
  EXPECT_TRUE(in_row_major_order(chosen));
  EXPECT_GT(chosen.size(), 12U * 5) << "each patch has an edge through it";
  EXPECT_LE(chosen.size(), 12U * 25);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) {
      const TemplatePoint* steepest = nullptr;
      for (const TemplatePoint& p : points)
        if (column(p) / 40 == x && row(p) / 40 == y &&
            (steepest == nullptr || gradient(p) > gradient(*steepest)))
          steepest = &p;
      if (steepest == nullptr) continue;
      EXPECT_TRUE(std::any_of(chosen.begin(), chosen.end(),
                              [&](const TemplatePoint& p) {
                                return column(p) == column(*steepest) && row(p) == row(*steepest);
                              }))
          << x << ' ' << y;
    }
}

TEST(PointSelection, OfNothingIsNothing) {
  for (const Kind kind : {Kind::kRandom, Kind::kDense, Kind::kSemiDense, Kind::kSparsePatches}) {
    PointSelector selector(options_of(kind), small_camera());
    EXPECT_TRUE(selector.select({}).empty());
  }
}

}  // namespace
}  // namespace saccade
