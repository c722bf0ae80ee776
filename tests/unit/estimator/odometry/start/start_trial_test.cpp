#include "estimator/odometry/start/start_trial.h"

#include <gtest/gtest.h>

#include <vector>

namespace saccade {
namespace {

constexpr double kTrialFrom_s = 0.2;

/// A pose every 10 ms until `until_s`, of this probability in the trial and of another elsewhere.
std::vector<TrackedPose> poses_of(double probability, double elsewhere, double until_s) {
  std::vector<TrackedPose> poses;
  for (int i = 1; 0.01 * i <= until_s; ++i) {
    TrackedPose pose;
    pose.t_ns = ns_from_seconds(0.01 * i);
    const bool is_in_trial = 0.01 * i > kTrialFrom_s && 0.01 * i <= kTrialFrom_s + kStartTrial_s;
    pose.probability = is_in_trial ? probability : elsewhere;
    poses.push_back(pose);
  }
  return poses;
}

StartTrial trial_until(double end_s, const std::vector<TrackedPose>& poses) {
  return start_trial(poses, std::vector<Event>{{ns_from_seconds(end_s), 0, 0, 1}}, kTrialFrom_s);
}

TEST(StartTrial, IsPassedByPosesThatAreMoreLikelyRight) {
  const StartTrial trial = trial_until(1, poses_of(0.6, 0, 1));
  EXPECT_TRUE(trial.is_passed());
  EXPECT_NEAR(trial.probability, 0.6, 1e-12);
}

TEST(StartTrial, IsNotByThoseThatAreMoreLikelyWrong) {
  const StartTrial trial = trial_until(1, poses_of(0.4, 1, 1));
  EXPECT_EQ(trial.outcome, StartTrial::Outcome::kUnexplained);
  EXPECT_NEAR(trial.probability, 0.4, 1e-12);
}

TEST(StartTrial, IsNotWithoutPosesWhereTheRecordingGoesOn) {
  const std::vector<TrackedPose> before = poses_of(1, 1, kTrialFrom_s);
  for (const double end_s : {1.0, kTrialFrom_s + 0.6 * kStartTrial_s})
    EXPECT_EQ(trial_until(end_s, before).outcome, StartTrial::Outcome::kNoPose);
  EXPECT_TRUE(trial_until(kTrialFrom_s + 0.4 * kStartTrial_s, before).is_passed());
}

}  // namespace
}  // namespace saccade
