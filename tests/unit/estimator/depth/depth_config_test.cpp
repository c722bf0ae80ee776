#include "estimator/depth/depth_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "core/config/config.h"
#include "tests/support/error_of.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

DepthConfig parsed(const std::string& yaml) {
  return config::read<DepthConfig>(config::parse(yaml, "t.yaml"));
}

TEST(DepthConfig, TheShippedFileHoldsTheDefaults) {
  const auto document = config::load(testing::source_path("configs/depth/thesis.yaml"));
  EXPECT_EQ(config::print(config::read<DepthConfig>(document)), config::print(DepthConfig{}));
}

TEST(DepthConfig, TheShippedFilesOfTheOtherMethodsHoldTheirDefaults) {
  const struct {
    const char* name;
    std::string_view method;
    double parallax_px;
  } files[] = {{"best", DepthConfig::Method::kRays, 20}, {"sweep", DepthConfig::Method::kSweep, 0}};
  for (const auto& [name, method, parallax_px] : files) {
    const auto document = config::load(testing::source_path("configs/depth/") + name + ".yaml");
    DepthConfig expected;
    expected.method = method;
    expected.window.reference = ViewWindowOptions::Reference::kMiddle;
    expected.parallax_px = parallax_px;
    EXPECT_EQ(config::print(config::read<DepthConfig>(document)), config::print(expected)) << name;
  }
}

TEST(DepthConfig, ReadsWhatItPrints) {
  const std::string yaml =
      "{window: {events: 5000, reference: end}, depth_range_m: [1, 9], "
      "thesis: {initial_depth_m: 2, events_per_px: 0.1}, seed: 5}";
  const DepthConfig config = parsed(yaml);
  EXPECT_EQ(config.window.events, 5000);
  EXPECT_EQ(config.limits.near_m, 1);
  EXPECT_EQ(config.limits.far_m, 9);
  EXPECT_EQ(config.thesis.events_per_px, 0.1);
  const std::string printed = config::print(config);
  EXPECT_EQ(config::print(parsed(printed)), printed);
}

TEST(DepthConfig, NamesWhatIsWrong) {
  const auto error = [](const std::string& yaml) { return error_of([&] { return parsed(yaml); }); };
  EXPECT_THAT(error("method: guess"), HasSubstr("t.yaml:1"));
  EXPECT_THAT(error("window: {duration_s: 0}"), HasSubstr("window.duration_s"));
  EXPECT_THAT(error("window: {events: 10}"), HasSubstr("window.events"));
  EXPECT_THAT(error("window: {by: events}"), HasSubstr("window.events"));
  EXPECT_THAT(error("depth_range_m: [3, 2]"), HasSubstr("must be below the second"));
  EXPECT_THAT(error("depth_range_m: [0, 2]"), HasSubstr("depth_range_m"));
  EXPECT_THAT(error("range_m: {near: 1}"), HasSubstr("depth_range_m"));
  EXPECT_THAT(error("thesis: {events_per_px: -1}"), HasSubstr("events_per_px"));
  EXPECT_THAT(error("thesis: {event_per_px: 3}"), HasSubstr("events_per_px"));
  EXPECT_THAT(error("thesis: {max_sigma: 0}"), HasSubstr("max_sigma"));
  EXPECT_THAT(error("thesis: {initial_depth_m: 0}"), HasSubstr("initial_depth_m"));
  EXPECT_THAT(error("{method: sweep, rays: {}}"), HasSubstr("method: rays"));
}

}  // namespace
}  // namespace saccade
