#include "eval/metrics/trajectory/scored_samples.h"

#include <gtest/gtest.h>

#include "tests/unit/eval/metrics/hand_made.h"

namespace saccade {
namespace {

using testing::joined;
using testing::straight;

double x_of(const Rigid3& pose) { return pose.translation().x(); }

TEST(ScoredInterval, IsTheWindowCutToTheTruth) {
  const Trajectory truth = straight(1, 3, 0.01);
  EXPECT_DOUBLE_EQ(scored_interval(truth, std::nullopt)->start_s, 1);
  EXPECT_DOUBLE_EQ(scored_interval(truth, std::nullopt)->end_s, truth.end_s());
  const auto cut = scored_interval(truth, RunRecord::Window{0, 2});
  EXPECT_DOUBLE_EQ(cut->start_s, 1);
  EXPECT_DOUBLE_EQ(cut->end_s, 2);
  EXPECT_FALSE(scored_interval(truth, RunRecord::Window{4, 5}));
  EXPECT_FALSE(scored_interval({}, RunRecord::Window{0, 1}));
}

TEST(HeldPose, InterpolatesShortGapsAndHoldsLongOnes) {
  const Trajectory poses = joined(straight(0, 0.04, 0.02), straight(0.1, 0.1, 0.02));
  EXPECT_NEAR(x_of(held_pose(poses, 0.01)), 0.01, 1e-12);
  EXPECT_NEAR(x_of(held_pose(poses, 0.099)), 0.04, 1e-12);
  EXPECT_NEAR(x_of(held_pose(poses, 0.1)), 0.1, 1e-12);
}

TEST(HeldPose, HoldsTheFirstAndLastPoseOutside) {
  const Trajectory poses = straight(1, 2, 0.01);
  EXPECT_NEAR(x_of(held_pose(poses, 0)), 1, 1e-12);
  EXPECT_NEAR(x_of(held_pose(poses, 5)), 2, 1e-12);
}

TEST(Coverage, CountsTheTimeWithAFreshPose) {
  EXPECT_DOUBLE_EQ(coverage(straight(0, 1, 0.01), {0, 1}), 1);
  // Poses from 0 to 0.5 cover 0.52 s of the second; the one at its very end nothing more.
  EXPECT_NEAR(coverage(joined(straight(0, 0.5, 0.01), straight(1, 1, 0.01)), {0, 1}), 0.52, 1e-9);
}

TEST(Coverage, WhatIsMissingAtEitherEndCounts) {
  EXPECT_NEAR(coverage(straight(0.3, 0.8, 0.01), {0, 1}), 0.52, 1e-9);
  // A pose from before the window still covers its first milliseconds.
  EXPECT_NEAR(coverage(straight(-0.01, -0.01, 1), {0, 1}), 0.01, 1e-9);
  EXPECT_EQ(coverage(straight(2, 3, 0.01), {0, 1}), 0);
  EXPECT_EQ(coverage({}, {0, 1}), 0);
}

TEST(Coverage, SparsePosesCoverTwentyMillisecondsEach) {
  EXPECT_NEAR(coverage(straight(0, 0.9, 0.1), {0, 1}), 0.2, 1e-9);
}

TEST(Coverage, OfAnInstant) {
  EXPECT_EQ(coverage(straight(0, 1, 0.01), {0.5, 0.5}), 1);
  EXPECT_EQ(coverage(straight(0, 0.1, 0.01), {0.5, 0.5}), 0);
}

TEST(TakeSamples, EveryMillisecondBothEndsIncluded) {
  const ScoredSamples samples = take_samples(straight(0, 1, 0.01), straight(0, 1, 0.1), {0.2, 0.7});
  ASSERT_EQ(samples.t_s.size(), 501U);
  EXPECT_DOUBLE_EQ(samples.t_s.front(), 0.2);
  EXPECT_DOUBLE_EQ(samples.t_s.back(), 0.7);
  EXPECT_NEAR(x_of(samples.truth[123]), 0.323, 1e-12);
  EXPECT_NEAR(x_of(samples.estimated[123]), 0.323, 1e-12);
  EXPECT_TRUE(take_samples({}, straight(0, 1, 0.1), {0, 1}).t_s.empty());
}

}  // namespace
}  // namespace saccade
