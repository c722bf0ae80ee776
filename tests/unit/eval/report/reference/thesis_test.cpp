#include "eval/report/reference/thesis.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

RunRecord run_with(const std::string& config) {
  RunRecord run;
  run.module = "track";
  run.config_yaml = config;
  return run;
}

const RunRecord kAccurate = run_with("align: {samples: 500, iterations: 30}\n");
const RunRecord kFast = run_with("align:\n  samples: 50\n  iterations: 5\n");

TEST(Thesis, ReadsTheKeysOfFormerVersionsToo) {
  const RunRecord fast = run_with("edges: {samples: 50, iterations: 5}\n");
  EXPECT_EQ(thesis_value("speed.poses_per_s", "walls", fast), 11427);
  const RunRecord other = run_with("edges: {samples: 50, iterations: 6}\n");
  EXPECT_EQ(thesis_value("speed.poses_per_s", "walls", other), 633);
}

TEST(Thesis, HasItsTablesByTheConfiguration) {
  EXPECT_EQ(thesis_value("dataset.events", "Walls", kAccurate), 1.8e6);
  EXPECT_EQ(thesis_value("dataset.events", "Walls", kFast), 1.8e6);
  EXPECT_EQ(thesis_value("dataset.events", "desk", kAccurate), std::nullopt);
  EXPECT_EQ(thesis_value("trajectory.dt_rel_percent.max", "office", kAccurate), 4.9);
  EXPECT_EQ(thesis_value("trajectory.dtheta_deg.sigma", "planes", RunRecord{}), 0.1);
  EXPECT_EQ(thesis_value("speed.poses_per_s", "walls", kFast), 11427);
  EXPECT_EQ(thesis_value("speed.poses_per_s", "planes", kFast), std::nullopt);
  EXPECT_EQ(thesis_value("speed.realtime_factor", "walls", kFast), std::nullopt);
}

// The erratum: the rate follows from the events and the time, not from what is printed.
TEST(Thesis, TheFastRateFollowsFromTheEvents) {
  EXPECT_NEAR(*thesis_value("speed.events_per_s", "walls", kFast),
              *thesis_value("dataset.events", "walls", kFast) /
                  *thesis_value("speed.wall_s", "walls", kFast),
              0.5e6);
  EXPECT_NE(thesis_protocol("speed.events_per_s").find("204 M"), std::string::npos);
}

}  // namespace
}  // namespace saccade
