#include "eval/metrics/trajectory/reprojection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

const PinholeCamera kCamera{100, 80, 100, 100, 49.5, 39.5, {}};

Rigid3 moved_by(double x, double y, double z) {
  return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, y, z)};
}

ScoredSamples samples(const std::vector<Rigid3>& estimated) {
  ScoredSamples s;
  for (std::size_t i = 0; i < estimated.size(); ++i) {
    s.t_s.push_back(0.001 * static_cast<double>(i));
    s.estimated.push_back(estimated[i]);
    s.truth.emplace_back();
  }
  return s;
}

TEST(Reprojection, OfAShiftIsFocalLengthTimesShiftOverDepth) {
  // 2 cm aside: 1 px at 2 m, 0.5 px at 4 m.
  const std::vector<Eigen::Vector3f> points{{0, 0, 2}, {0, 0, 4}};
  const ReprojectionSeries s =
      reproject(points, samples({moved_by(0.02, 0, 0), moved_by(0, 0, 0)}), kCamera);
  ASSERT_EQ(s.t_s.size(), 2U);
  EXPECT_NEAR(s.rms_px[0], std::sqrt((1 + 0.25) / 2), 1e-6);
  EXPECT_NEAR(s.max_px[0], 1, 1e-6);
  EXPECT_NEAR(s.rms_px[1], 0, 1e-9);
  EXPECT_NEAR(s.rms_all_px, std::sqrt(1.25 / 4), 1e-6);
  Metrics metrics;
  set_reprojection(metrics, s);
  EXPECT_NEAR(*metrics.get("trajectory.reprojection_px.rms_max"), std::sqrt(1.25 / 2), 1e-6);
  EXPECT_NEAR(*metrics.get("trajectory.reprojection_px.max"), 1, 1e-6);
}

TEST(Reprojection, CountsOnlyPointsThatTheTruePoseSees) {
  const std::vector<Eigen::Vector3f> points{{0, 0, 2}, {0, 0, -2}, {5, 0, 2}};
  const ReprojectionSeries s = reproject(points, samples({moved_by(0.02, 0, 0)}), kCamera);
  EXPECT_NEAR(s.rms_px[0], 1, 1e-6);
}

TEST(Reprojection, OfManyPointsIsThatOfEachOfThem) {
  // 37 points all around the camera: no whole number of those that are computed together.
  const Random random(5);
  std::vector<Eigen::Vector3f> points;
  for (std::uint64_t i = 0; i < 37; ++i)
    points.emplace_back(Eigen::Vector3d(2 * random.uniform(0, i) - 1, 2 * random.uniform(1, i) - 1,
                                        4 * random.uniform(2, i) - 1)
                            .cast<float>());
  const Rigid3 estimate(so3_exp({0.02, -0.01, 0.03}), {0.05, -0.02, 1});
  double squares = 0, max = 0, seen = 0;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d truly = point.cast<double>();
    if (truly.z() <= 0 || !kCamera.contains(kCamera.project(truly))) continue;
    const Eigen::Vector3d estimated = estimate.inverse() * truly;
    const double diagonal = std::hypot(100, 80);
    const double error =
        estimated.z() > 0
            ? std::min(diagonal, (kCamera.project(estimated) - kCamera.project(truly)).norm())
            : diagonal;
    squares += error * error;
    max = std::max(max, error);
    ++seen;
  }
  ASSERT_GT(seen, 9) << "the test needs points that are seen";
  const ReprojectionSeries s = reproject(points, samples({estimate}), kCamera);
  ASSERT_EQ(s.t_s.size(), 1U);
  EXPECT_NEAR(s.rms_px[0], std::sqrt(squares / seen), 1e-9);
  EXPECT_NEAR(s.max_px[0], max, 1e-9);
}

TEST(Reprojection, BehindTheEstimatedCameraCostsTheDiagonal) {
  const std::vector<Eigen::Vector3f> points{{0, 0, 2}};
  const ReprojectionSeries s = reproject(points, samples({moved_by(0, 0, 3)}), kCamera);
  EXPECT_NEAR(s.max_px[0], std::hypot(100, 80), 1e-9);
}

TEST(Reprojection, WithoutVisiblePointsIsNull) {
  Metrics metrics;
  set_reprojection(metrics, reproject({}, samples({moved_by(0, 0, 0)}), kCamera));
  EXPECT_EQ(metrics.values().size(), 3U);
  EXPECT_FALSE(metrics.get("trajectory.reprojection_px.rms"));
  set_reprojection(metrics, reproject(std::vector<Eigen::Vector3f>{{0, 0, 1}}, {}, kCamera));
  EXPECT_FALSE(metrics.get("trajectory.reprojection_px.max"));
}

TEST(Reprojection, ThinsOutLongSequences) {
  const ReprojectionSeries s =
      reproject(std::vector<Eigen::Vector3f>{{0, 0, 2}},
                samples(std::vector<Rigid3>(5000, moved_by(0.02, 0, 0))), kCamera);
  EXPECT_LE(s.t_s.size(), 2000U);
  EXPECT_GT(s.t_s.size(), 1000U);
}

}  // namespace
}  // namespace saccade
