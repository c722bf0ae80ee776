#include "estimator/run/run_writer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace saccade {
namespace {

RunTiming some_timing() {
  RunTiming timing;
  timing.wall_s = {2, 1, 4};
  timing.events = 100;
  timing.sequence_s = 3;
  return timing;
}

TEST(RunTiming, RatesAreOfTheMedianTheLongestAndTheShortestRepetition) {
  const nlohmann::json json = nlohmann::json::parse(to_json(some_timing()));
  EXPECT_EQ(json.at("wall_s").at("median"), 2);
  EXPECT_EQ(json.at("events_per_s").at("median"), 50);
  EXPECT_EQ(json.at("events_per_s").at("min"), 25);
  EXPECT_EQ(json.at("events_per_s").at("max"), 100);
  EXPECT_EQ(json.at("realtime_factor").at("median"), 1.5);
  EXPECT_FALSE(json.contains("poses"));
  EXPECT_FALSE(json.contains("latency_ms"));
  EXPECT_FALSE(json.contains("dropped_events"));
}

TEST(RunTiming, LatenciesAreMedianNinetyNinePercentAndMost) {
  RunTiming timing = some_timing();
  for (int i = 100; i >= 0; --i) timing.latency_ms.push_back(i);
  timing.dropped_events = 7;
  const nlohmann::json json = nlohmann::json::parse(to_json(timing));
  EXPECT_EQ(json.at("latency_ms").at("median"), 50);
  EXPECT_EQ(json.at("latency_ms").at("p99"), 99);
  EXPECT_EQ(json.at("latency_ms").at("max"), 100);
  EXPECT_EQ(json.at("dropped_events"), 7);
}

}  // namespace
}  // namespace saccade
