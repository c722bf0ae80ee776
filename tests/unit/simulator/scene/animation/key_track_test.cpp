#include "simulator/scene/animation/key_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/rigid3.h"

namespace saccade {
namespace {

TEST(KeyTrack, VectorsAreLinesBetweenKeysAndRestOutside) {
  const ModelTrack track{KeyInterpolation::kLinear, {1, 3}, {0, 1, 2, 4, 1, 0}};
  ASSERT_TRUE(is_valid(track, 3));
  EXPECT_EQ(vector_at(track, 0), Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(vector_at(track, 2), Eigen::Vector3d(2, 1, 1));
  EXPECT_EQ(vector_at(track, 9), Eigen::Vector3d(4, 1, 0));
}

TEST(KeyTrack, StepsHoldAKeyUntilTheNext) {
  const ModelTrack track{KeyInterpolation::kStep, {0, 1}, {0, 0, 0, 1, 1, 1}};
  EXPECT_EQ(vector_at(track, 0.999), Eigen::Vector3d::Zero());
  EXPECT_EQ(vector_at(track, 1), Eigen::Vector3d::Ones());
}

// The cubic with the slopes of t^3 is t^3 itself.
TEST(KeyTrack, CubicsFollowTheirSlopes) {
  const auto cube = [](double t) { return t * t * t; };
  const auto slope = [](double t) { return 3 * t * t; };
  ModelTrack track{KeyInterpolation::kCubic, {0.5, 2}, {}};
  for (const double t : {0.5, 2.0})
    for (const double value : {slope(t), cube(t), slope(t)})
      track.values.insert(track.values.end(), {value, 2 * value, -value});
  ASSERT_TRUE(is_valid(track, 3));
  for (const double t : {0.5, 0.7, 1.1, 1.9, 2.0})
    EXPECT_LT((vector_at(track, t) - cube(t) * Eigen::Vector3d(1, 2, -1)).norm(), 1e-12) << t;
}

TEST(KeyTrack, RotationsTakeTheShorterArcAtConstantRate) {
  const auto about_z = [](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  };
  ModelTrack track{KeyInterpolation::kLinear, {0, 1}, {}};
  const Eigen::Quaterniond last = about_z(1.5);
  // The second key has the opposite sign, which is the same rotation.
  track.values = {0, 0, 0, 1, -last.x(), -last.y(), -last.z(), -last.w()};
  for (const double t : {0.0, 0.25, 0.8, 1.0})
    EXPECT_LT(rotation_at(track, t).angularDistance(about_z(1.5 * t)), 1e-12) << t;
}

TEST(KeyTrack, WithTooFewValuesOrTimesOutOfOrderAreNotValid) {
  EXPECT_FALSE(is_valid({KeyInterpolation::kLinear, {0, 1}, {0, 0, 0}}, 3));
  EXPECT_FALSE(is_valid({KeyInterpolation::kCubic, {0}, {0, 0, 0}}, 3));
  EXPECT_FALSE(is_valid({KeyInterpolation::kLinear, {1, 0}, {0, 0, 0, 0, 0, 0}}, 3));
  EXPECT_FALSE(is_valid(
      {KeyInterpolation::kLinear, {0}, {0, std::numeric_limits<double>::infinity(), 0}}, 3));
}

}  // namespace
}  // namespace saccade
