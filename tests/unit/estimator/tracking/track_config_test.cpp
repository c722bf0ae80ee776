#include "estimator/tracking/track_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/config/config.h"
#include "tests/support/error_of.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

TrackConfig parse(const std::string& yaml) {
  return config::read<TrackConfig>(config::parse(yaml, "t.yaml"));
}

TEST(TrackConfig, DefaultsAreTheAccurateSetting) {
  const TrackConfig config = parse("{}");
  EXPECT_EQ(config.edges.align.samples, 500);
  EXPECT_EQ(config.edges.align.iterations, 30);
  EXPECT_EQ(config.edges.event_frame.event_map_ratio, 0.4);
  EXPECT_FALSE(config.initial_pose);
}

TEST(TrackConfig, FilesOfTheSettingsAreValid) {
  const std::string folder = testing::source_path("configs/tracking/");
  const auto accurate = config::read<TrackConfig>(config::load(folder + "accurate.yaml"));
  EXPECT_EQ(accurate.edges.align.samples, 500);
  EXPECT_EQ(accurate.edges.align.iterations, 30);
  EXPECT_EQ(accurate.edges.event_frame.event_map_ratio, 0.4);
  const auto fast = config::read<TrackConfig>(config::load(folder + "fast.yaml"));
  EXPECT_EQ(fast.edges.align.samples, 50);
  EXPECT_EQ(fast.edges.align.iterations, 5);
  EXPECT_EQ(fast.edges.event_frame.event_map_ratio, 0.09);
  const auto best = config::read<TrackConfig>(config::load(folder + "best.yaml"));
  EXPECT_EQ(best.method, "intensity");
  EXPECT_FALSE(best.intensity.events.has_value());
  EXPECT_EQ(best.motion.acceleration_sigma_px, 300);
  EXPECT_EQ(best.motion.acceleration_per_speed, 6);
  EXPECT_EQ(best.reference.new_view_deg, 15);
  EXPECT_FALSE(best.contrast_on) << "the dataset's";
  EXPECT_FALSE(best.contrast_off) << "the dataset's";
  const auto polarity = config::read<TrackConfig>(config::load(folder + "polarity.yaml"));
  EXPECT_EQ(polarity.method, "polarity");
  EXPECT_EQ(polarity.polarity.events, 3000);
}

TEST(TrackConfig, PrintedConfigurationMeansTheSame) {
  const TrackConfig config = parse(
      "{reference: {planar_depth_m: 0.7, region_px: [1, 2, 30, 40]},"
      " edges: {preset: fast, iterations: 7}, motion: {acceleration_sigma_px: 123},"
      " initial_pose: [1, 2, 3, 0, 0, 0, 1], seed: 9}");
  const std::string printed = config::print(config);
  EXPECT_EQ(config::print(parse(printed)), printed);
  const TrackConfig again = parse(printed);
  EXPECT_EQ(again.motion.acceleration_sigma_px, 123);
  EXPECT_EQ(again.initial_pose, config.initial_pose);
  EXPECT_EQ(again.reference.region_px, config.reference.region_px);
  EXPECT_EQ(again.edges.align.iterations, 7);
  EXPECT_EQ(again.edges.align.samples, 50);
  EXPECT_TRUE(again.edges.align.smooth) << "of the preset, without a key";
}

TEST(TrackConfig, PrintedIntensityConfigurationMeansTheSame) {
  const TrackConfig config = parse(
      "{method: intensity, reference: {new_view_deg: 7}, intensity: {events: 321, "
      "map_blur_px: 0, contrast_on: 0.17, contrast_off: 0.18}, motion: {acceleration_sigma_px: "
      "3}}");
  const std::string printed = config::print(config);
  EXPECT_EQ(config::print(parse(printed)), printed);
  const TrackConfig again = parse(printed);
  EXPECT_EQ(again.method, "intensity");
  EXPECT_EQ(again.reference.new_view_deg, 7);
  EXPECT_EQ(again.intensity.events, 321);
  EXPECT_EQ(again.intensity.map_blur_px, 0);
  EXPECT_EQ(again.contrast_on, 0.17);
  EXPECT_EQ(again.contrast_off, 0.18);
  EXPECT_EQ(again.motion.acceleration_sigma_px, 3);
  EXPECT_EQ(again.motion.acceleration_per_speed, 6) << "of the method, without a key";
}

TEST(TrackConfig, PrintedPolarityConfigurationMeansTheSame) {
  const TrackConfig config = parse("{method: polarity, polarity: {events: 321, reversals: false}}");
  const std::string printed = config::print(config);
  EXPECT_EQ(config::print(parse(printed)), printed);
  const TrackConfig again = parse(printed);
  EXPECT_EQ(again.method, "polarity");
  EXPECT_EQ(again.polarity.events, 321);
  EXPECT_FALSE(again.polarity.reversals);
}

struct Fault {
  std::string yaml;
  std::string place;
};

TEST(TrackConfig, FaultsNameTheirPlace) {
  const std::vector<Fault> faults{
      {"{sampels: 3}", "sampels"},
      {"{edges: {sampels: 50}}", "did you mean 'samples'"},
      {"{edges: {samples: 3}}", "edges.samples"},
      {"{edges: {iterations: 0}}", "edges.iterations"},
      {"{edges: {iterations: 2.5}}", "edges.iterations"},
      {"{edges: {preset: best}}", "edges.preset"},
      {"{edges: {pyramid_levels: 0}}", "edges.pyramid_levels"},
      {"{edges: {robust_loss: cauchy}}", "edges.robust_loss"},
      {"{edges: {selection: sparse}}", "edges.selection"},
      {"{edges: {event_map_ratio: 0}}", "edges.event_map_ratio"},
      {"{edges: {event_window: slides}}", "edges.event_window"},
      {"{edges: {event_frame: surface}}", "edges.event_frame"},
      {"{motion: {prediction: constant_velocity, time_offset_s: 0.1}}", "prediction: imu"},
      {"{motion: {prediction: imu, time_offset_s: 2}}", "motion.time_offset_s"},
      {"{motion: {prediction: none, acceleration_sigma_px: 100}}", "acceleration_sigma_px"},
      {"{reference: {planar_depth_m: 0}}", "reference.planar_depth_m"},
      {"{reference: {frame: -1}}", "reference.frame"},
      {"{reference: {region_px: [1, 2, 3]}}", "reference.region_px"},
      {"{reference: {new_view_deg: 0}}", "reference.new_view_deg"},
      {"{method: levels}", "method"},
      {"{method: frame}", "did you mean 'frames'"},
      {"{method: frames, frames: {samples: 100}}", "frames"},
      {"{method: frames, intensity: {events: 100}}", "intensity"},
      {"{method: intensity, edges: {samples: 100}}", "edges"},
      {"{method: intensity, intensity: {events: 0}}", "intensity.events"},
      {"{method: intensity, intensity: {mismatch_sigma: 1.5}}", "intensity.mismatch_sigma"},
      {"{method: intensity, intensity: {correction_fraction: 0.1}}", "intensity.mismatch_sigma"},
      {"{method: intensity, intensity: {contrast_on: 0}}", "intensity.contrast_on"},
      {"{method: intensity, intensity: {contrast_off: 0}}", "intensity.contrast_off"},
      {"{method: intensity, intensity: {contrast: 0.2}}", "intensity.contrast_on"},
      {"{intensity: {events: 500}}", "intensity"},
      {"{method: polarity, motion: {prediction: none}}", "polarity needs a motion.prediction"},
      {"{method: polarity, polarity: {events: 0}}", "polarity.events"},
      {"{polarity: {events: 100}}", "polarity"},
      {"{initial_pose: [0, 0, 0]}", "initial_pose"},
      {"{seed: -1}", "seed"},
  };
  for (const Fault& fault : faults) {
    const std::string error = error_of([&] { return parse(fault.yaml); });
    EXPECT_THAT(error, HasSubstr("t.yaml")) << fault.yaml;
    EXPECT_THAT(error, HasSubstr(fault.place)) << fault.yaml;
  }
}

TEST(TrackConfig, TheThesisPresetLeavesOutTheImprovements) {
  const TrackConfig config = parse("{edges: {preset: thesis}}");
  EXPECT_FALSE(config.edges.templates.bilinear);
  EXPECT_FALSE(config.edges.align.solve_brightness);
  EXPECT_FALSE(config.map.foreground_depth);
  EXPECT_EQ(config.map.max_fraction, 1);
  EXPECT_EQ(config.motion.prediction, MotionModelOptions::Prediction::kNone);
}

TEST(TrackConfig, ThePresetForANarrowViewHoldsItsMotionModelToo) {
  const TrackConfig config = parse("{edges: {preset: narrow_view}}");
  EXPECT_EQ(config.edges.templates.blur_size_px, 5);
  EXPECT_EQ(config.edges.event_frame.event_map_ratio, 0.2);
  EXPECT_EQ(config.motion.acceleration_sigma_px, 20);
}

TEST(TrackConfig, EveryMethodPrintsAConfigurationThatItReads) {
  for (const TrackMethod& method : track_methods()) {
    const std::string name(method.name);
    EXPECT_TRUE(method.help.ends_with('.')) << name;
    const std::string printed = config::print(parse("{method: " + name + "}"));
    EXPECT_EQ(config::print(parse(printed)), printed) << name;
  }
}

TEST(TrackConfig, EveryKeyHasHelp) {
  const std::string printed = config::print_documented(TrackConfig{});
  std::size_t begin = 0;
  while (begin < printed.size()) {
    const std::size_t end = printed.find('\n', begin);
    const std::string line = printed.substr(begin, end - begin);
    if (!line.empty()) {
      EXPECT_THAT(line, HasSubstr("  # "));
    }
    begin = end == std::string::npos ? printed.size() : end + 1;
  }
}

}  // namespace
}  // namespace saccade
