#include "core/spline/knots.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

Rigid3 motion(double t_s) {
  return {so3_exp({0.4 * t_s, -0.9 * t_s * t_s, 0.7 * std::sin(3 * t_s)}),
          {std::sin(2 * t_s), 0.3 * t_s, std::cos(t_s)}};
}

std::vector<StampedPose> poses() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i) poses.push_back({0.2 + 0.01 * i, motion(0.2 + 0.01 * i)});
  return poses;
}

std::array<Rigid3, 4> four(const SplineControls& controls, std::size_t first) {
  return {controls.poses[first], controls.poses[first + 1], controls.poses[first + 2],
          controls.poses[first + 3]};
}

TEST(SplineKnots, AreWholeSegmentsOverTheSpan) {
  const SplineKnots knots = SplineKnots::over(0.2, 1.2, 0.09);
  EXPECT_EQ(knots.segments, 11U);
  EXPECT_EQ(knots.controls(), 14U);
  EXPECT_NEAR(knots.end_s(), 1.2, 1e-12);
  EXPECT_EQ(knots.at(-1).first, 0U);
  EXPECT_EQ(knots.at(7).first, 10U);
  EXPECT_EQ(SplineKnots::over(0, 1, 5).segments, 1U);
}

TEST(SplineKnots, WeightsAreThoseOfTheUniformBasis) {
  const SplineKnots knots{0, 1, 5};
  const auto place = knots.at(2);
  EXPECT_EQ(place.first, 2U);
  EXPECT_TRUE(place.weight.isApprox(Eigen::Vector4d(1, 4, 1, 0) / 6, 1e-12));
  EXPECT_NEAR(knots.at(2.7).weight.sum(), 1, 1e-12);
  // The second of the four has its greatest weight where it stands.
  EXPECT_EQ(knots.time_s(place.first + 1), 2);
}

TEST(SplineControls, GiveTheSmoothSpline) {
  const SplineControls controls = SplineControls::smooth(poses(), 0.1);
  const Spline spline = Spline::smooth(poses(), 0.1);
  ASSERT_EQ(controls.poses.size(), controls.knots.controls());
  for (const double t_s : {0.2, 0.55, 0.73, 1.2}) {
    const SplineKnots::LocalBasis place = controls.knots.at(t_s);
    const Rigid3 pose = pose_over(place, four(controls, place.first)).world_from_body;
    EXPECT_LT((pose.translation() - spline.pose(t_s).translation()).norm(), 1e-12);
    EXPECT_LT(angle_between(pose.rotation(), spline.pose(t_s).rotation()), 1e-12);
  }
}

TEST(SplineControls, RotationHasItsDerivativeByTheControls) {
  const SplineControls controls = SplineControls::smooth(poses(), 0.1);
  const SplineKnots::LocalBasis place = controls.knots.at(0.64);
  const auto turned = [&](const Eigen::Matrix<double, 12, 1>& turns) {
    std::array<Rigid3, 4> changed = four(controls, place.first);
    for (std::size_t k = 0; k < 4; ++k)
      changed[k] = changed[k] * Rigid3(so3_exp(turns.segment<3>(static_cast<Eigen::Index>(3 * k))),
                                       Eigen::Vector3d::Zero());
    return pose_over(place, changed);
  };
  const Eigen::Matrix<double, 12, 1> none = Eigen::Matrix<double, 12, 1>::Zero();
  const PoseOverControls pose = turned(none);
  testing::expect_jacobian<3, 12>(
      pose.rotation_jacobian,
      [&](const Eigen::Matrix<double, 12, 1>& turns) {
        return so3_log(pose.world_from_body.rotation().conjugate() *
                       turned(turns).world_from_body.rotation());
      },
      none);
}

}  // namespace
}  // namespace saccade
