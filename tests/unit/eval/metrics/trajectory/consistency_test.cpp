#include "eval/metrics/trajectory/consistency.h"

#include <gtest/gtest.h>

#include "tests/unit/eval/metrics/hand_made.h"

namespace saccade {
namespace {

using testing::straight;

TrajectoryScoreInput some_input() {
  return {.estimate = straight(0, 2, 0.01, 1, {0, 0.02, 0}),
          .truth = straight(0, 2, 0.01),
          .window = {},
          .mean_depth_m = 2,
          .reported = {}};
}

TEST(Nees, IsTheErrorInUnitsOfItsDeviation) {
  // Two deviations off.
  const Matrix6 covariance = 1e-4 * Matrix6::Identity();
  const StampedCovariance entries[] = {{0.5, covariance}, {1.5, 4 * covariance}, {9, covariance}};
  EXPECT_NEAR(*nees(entries, some_input()), (4.0 + 1.0) / 2, 1e-9);
}

TEST(Nees, IsNoneWithoutCovarianceTruthOrEstimate) {
  EXPECT_FALSE(nees({}, some_input()));
  const StampedCovariance zero[] = {{0.5, Matrix6::Zero()}};
  EXPECT_FALSE(nees(zero, some_input()));
  const StampedCovariance entries[] = {{0.5, Matrix6::Identity()}};
  TrajectoryScoreInput input = some_input();
  input.truth = {};
  EXPECT_FALSE(nees(entries, input));
  input = some_input();
  input.estimate = {};
  EXPECT_FALSE(nees(entries, input));
  input = some_input();
  input.freedom = Alignment::kSim3;
  EXPECT_FALSE(nees(entries, input)) << "covariances say nothing of where a world lies";
}

}  // namespace
}  // namespace saccade
