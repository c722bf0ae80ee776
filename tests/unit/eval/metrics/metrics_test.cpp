#include "eval/metrics/metrics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"

namespace saccade {
namespace {

TEST(Metrics, WritesNestedSortedJsonWithNullForWhatIsNotMeasured) {
  Metrics metrics;
  metrics.set("trajectory.poses", 12);
  metrics.set("trajectory.dt_rel_percent.mean", 0.25);
  metrics.set("trajectory.dt_rel_percent.max", std::nullopt);
  metrics.set("speed.events", 1800000);
  EXPECT_EQ(to_json(metrics), R"({
  "speed": {
    "events": 1800000
  },
  "trajectory": {
    "dt_rel_percent": {
      "max": null,
      "mean": 0.25
    },
    "poses": 12
  }
}
)");
}

TEST(Metrics, NeverHoldsNanOrInfinity) {
  Metrics metrics;
  metrics.set("a", std::nan(""));
  metrics.set("b", std::numeric_limits<double>::infinity());
  EXPECT_EQ(metrics.get("a"), std::nullopt);
  EXPECT_EQ(metrics.get("b"), std::nullopt);
  EXPECT_EQ(metrics.values().size(), 2U);
  EXPECT_EQ(metrics.get("c"), std::nullopt);
}

TEST(Metrics, ReadsBackExactlyWhatItWrote) {
  Metrics metrics;
  metrics.set("a.third", 1.0 / 3);
  metrics.set("a.tiny", 5e-324);
  metrics.set("a.count", 9007199254740991.0);
  metrics.set("b", std::nullopt);
  EXPECT_EQ(parse_json_metrics(to_json(metrics), "text"), metrics);
  EXPECT_EQ(parse_json_metrics(to_json(Metrics{}), "text"), Metrics{});
}

TEST(Metrics, SkipsLeavesThatAreNoNumbers) {
  const Metrics metrics =
      parse_json_metrics(R"({"wall_s": {"median": 0.5}, "cpu": "x", "runs": [1, 2]})", "timing");
  EXPECT_EQ(metrics.values().size(), 1U);
  EXPECT_EQ(metrics.get("wall_s.median"), 0.5);
}

TEST(Metrics, RefusesTextThatIsNoJsonObject) {
  EXPECT_THROW((void)parse_json_metrics("[1]", "x.json"), InputError);
  EXPECT_THROW((void)parse_json_metrics(R"({"a": nan})", "x.json"), InputError);
  EXPECT_THROW((void)parse_json_metrics(R"({"a": 1e999})", "x.json"), InputError);
  EXPECT_THROW((void)read_json_metrics("no/such/file.json"), InputError);
}

}  // namespace
}  // namespace saccade
