#include "estimator/depth/rays/local_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

constexpr float kSigma = 0.002F;

float plane(float x, float y) { return 0.5F + 0.002F * x - 0.001F * y; }

/// A slanted plane; right of x = 20 another one, nearer by `discontinuity`.
std::vector<EdgePoint> points(float discontinuity) {
  std::vector<EdgePoint> points;
  for (int y = 0; y < 40; y += 2)
    for (int x = 0; x < 40; x += 2) {
      const auto px = static_cast<float>(x), py = static_cast<float>(y);
      const float noise = kSigma * static_cast<float>(Random(5).normal(0, points.size()));
      points.push_back({px, py, plane(px, py) + noise + (x >= 20 ? discontinuity : 0.F), kSigma});
    }
  return points;
}

TEST(LocalPlanes, FindsThePlaneWhereThereIsNoPoint) {
  LocalPlanes planes(points(0), {});
  const LocalPlane fit = planes.fit({17.3F, 21.7F, 0.5F, kSigma});
  EXPECT_NEAR(fit.inverse_depth, plane(17.3F, 21.7F), 3 * fit.sigma);
  EXPECT_LT(fit.sigma, kSigma / 2);
  EXPECT_NEAR(fit.slope.x(), 0.002, 5e-4);
  EXPECT_NEAR(fit.slope.y(), -0.001, 5e-4);
  EXPECT_GT(fit.weights, 20);
}

TEST(LocalPlanes, SigmaIsTheDeviationOfTheResult) {
  LocalPlanes planes(points(0), {.model_error = 0});
  int within = 0, tried = 0;
  for (float y = 3; y < 37; y += 1.7F)
    for (float x = 3; x < 37; x += 1.7F, ++tried) {
      const LocalPlane fit = planes.fit({x, y, plane(x, y), kSigma});
      if (std::abs(fit.inverse_depth - plane(x, y)) <= fit.spread * fit.sigma) ++within;
    }
  // Of 68 %; neighbouring fits share their points, so that few of them are independent.
  EXPECT_GT(within, 0.5 * tried);
  EXPECT_LT(within, 0.85 * tried);
}

TEST(LocalPlanes, StaysOnTheSurfaceItStartsFrom) {
  LocalPlanes planes(points(0.2F), {});
  const LocalPlane left = planes.fit({19, 20, plane(19, 20), kSigma});
  const LocalPlane right = planes.fit({19, 20, plane(19, 20) + 0.2F, kSigma});
  EXPECT_NEAR(left.inverse_depth, plane(19, 20), 0.003F);
  EXPECT_NEAR(right.inverse_depth, plane(19, 20) + 0.2F, 0.003F);
}

TEST(LocalPlanes, TheGapIsThatToTheOtherSurface) {
  LocalPlanes planes(points(0.2F), {});
  const LocalPlane left = planes.fit({19, 20, plane(19, 20), kSigma});
  EXPECT_NEAR(planes.gap_around(19, 20, left), 0.2, 0.01);
  const LocalPlane far = planes.fit({6, 20, plane(6, 20), kSigma});
  EXPECT_TRUE(std::isinf(planes.gap_around(6, 20, far)));
}

TEST(LocalPlanes, OneWrongPointIsNoSurface) {
  std::vector<EdgePoint> some = points(0);
  some[210].inverse_depth += 0.3F;
  LocalPlanes planes(some, {});
  const float x = some[210].x_px, y = some[210].y_px;
  const LocalPlane fit = planes.fit({x, y, plane(x, y), kSigma});
  EXPECT_NEAR(fit.inverse_depth, plane(x, y), 0.003F);
  EXPECT_TRUE(std::isinf(planes.gap_around(x, y, fit)));
}

/// Every other column and row of points(): some ten within the radius, and twenty within the wider one.
std::vector<EdgePoint> sparse_points(float discontinuity) {
  std::vector<EdgePoint> sparse;
  for (const EdgePoint& point : points(discontinuity))
    if (std::fmod(point.x_px, 4) == 0 && std::fmod(point.y_px, 4) == 0) sparse.push_back(point);
  return sparse;
}

TEST(LocalPlanes, FewPointsAreJoinedByThoseFartherAway) {
  LocalPlanes planes(sparse_points(0), {});
  const EdgePoint start{13, 21, plane(13, 21), kSigma};
  const LocalPlane narrow = planes.fit(start), wide = planes.fit_widened(start);
  EXPECT_GT(wide.weights, 1.5F * narrow.weights);
  EXPECT_LT(wide.sigma, 0.9F * narrow.sigma);
  LocalPlanes dense(points(0), {});
  EXPECT_EQ(dense.fit_widened(start).weights, dense.fit(start).weights);
}

TEST(LocalPlanes, NearAnotherSurfaceFewPointsStayAlone) {
  LocalPlanes planes(sparse_points(0.2F), {});
  const EdgePoint start{11, 21, plane(11, 21), kSigma};  // 9 px before the discontinuity
  ASSERT_TRUE(std::isinf(planes.gap_around(11, 21, planes.fit(start))));
  EXPECT_EQ(planes.fit_widened(start).weights, planes.fit(start).weights);
}

TEST(LocalPlanes, PointsSurroundWhatIsInterpolated) {
  // So small a discontinuity that points beyond it are near enough to be tried.
  LocalPlanes planes(points(0.06F), {});
  EXPECT_TRUE(planes.surrounds_start(planes.fit({10.5F, 20.5F, plane(10.5F, 20.5F), kSigma})));
  // Beyond the border, and at the border before the other surface, whose points do not count.
  EXPECT_FALSE(planes.surrounds_start(planes.fit({-1, 20.5F, plane(-1, 20.5F), kSigma})));
  EXPECT_FALSE(planes.surrounds_start(planes.fit({19, 20.5F, plane(19, 20.5F), kSigma})));
}

TEST(LocalPlanes, NearestIsWithinTheRadius) {
  LocalPlanes planes(points(0), {});
  const EdgePoint* nearest = planes.nearest(10.7F, 13.2F);
  ASSERT_NE(nearest, nullptr);
  EXPECT_EQ(nearest->x_px, 10);
  EXPECT_EQ(nearest->y_px, 14);
  EXPECT_EQ(planes.nearest(100, 100), nullptr);
  EXPECT_EQ(LocalPlanes({}, {}).nearest(0, 0), nullptr);
}

}  // namespace
}  // namespace saccade
