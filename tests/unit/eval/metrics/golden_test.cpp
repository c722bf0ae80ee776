#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "core/io/covariance_file.h"
#include "core/io/trajectory_file.h"
#include "eval/metrics/trajectory/consistency.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr double kMeanDepthM = 1.7;

/// Trajectories whose scores another program computed (tests/golden/trajectories/README.md).
class GoldenTrajectories : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] static fs::path file(const char* name) {
    return fs::path(testing::source_path("tests/golden/trajectories")) / GetParam() / name;
  }
};

TEST_P(GoldenTrajectories, HaveTheScoresOfAnIndependentProgram) {
  const TrajectoryScoreInput input{.estimate = read_tum_trajectory(file("estimate.txt")),
                                   .truth = read_tum_trajectory(file("truth.txt")),
                                   .window = {},
                                   .mean_depth_m = kMeanDepthM,
                                   .reported = {}};
  Metrics scores = score_trajectory(input);
  std::optional<double> consistency;
  if (fs::exists(file("covariance.txt")))
    consistency = nees(read_covariances(file("covariance.txt")), input);
  scores.set("trajectory.nees", consistency);

  const Metrics expected = read_json_metrics(file("expected.json"));
  EXPECT_EQ(expected.values().size(), scores.values().size());
  for (const auto& [name, value] : expected.values()) {
    const std::string key = "trajectory." + name;
    ASSERT_TRUE(scores.values().contains(key)) << key;
    ASSERT_EQ(scores.get(key).has_value(), value.has_value()) << key;
    if (value) {
      EXPECT_NEAR(*scores.get(key), *value, 1e-9 * std::abs(*value)) << key;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Metrics, GoldenTrajectories,
                         ::testing::Values("noise", "gap", "rates", "sparse", "long", "three"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace saccade
