#include "eval/metrics/trajectory/reprojection.h"

#include <gtest/gtest.h>

#include <cmath>

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
