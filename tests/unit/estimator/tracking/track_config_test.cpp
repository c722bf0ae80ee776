#include "estimator/tracking/track_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/config/config.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

TrackConfig parse(const std::string& yaml) {
  return config::read<TrackConfig>(config::parse(yaml, "t.yaml"));
}

TEST(TrackConfig, DefaultsAreTheAccurateSetting) {
  const TrackConfig config = parse("{}");
  EXPECT_EQ(config.tracker.align.samples, 500);
  EXPECT_EQ(config.tracker.align.iterations, 30);
  EXPECT_EQ(config.tracker.event_frame.ratio, 0.4);
  EXPECT_FALSE(config.initial_pose);
}

TEST(TrackConfig, FilesOfTheSettingsAreValid) {
  const std::string folder = std::string(SACCADE_SOURCE_DIR) + "/configs/tracking/";
  const auto accurate = config::read<TrackConfig>(config::load(folder + "accurate.yaml"));
  EXPECT_EQ(accurate.tracker.align.samples, 500);
  EXPECT_EQ(accurate.tracker.align.iterations, 30);
  EXPECT_EQ(accurate.tracker.event_frame.ratio, 0.4);
  const auto fast = config::read<TrackConfig>(config::load(folder + "fast.yaml"));
  EXPECT_EQ(fast.tracker.align.samples, 50);
  EXPECT_EQ(fast.tracker.align.iterations, 5);
  EXPECT_EQ(fast.tracker.event_frame.ratio, 0.09);
  const auto best = config::read<TrackConfig>(config::load(folder + "best.yaml"));
  EXPECT_EQ(best.method, TrackConfig::Method::kIntensity);
  EXPECT_FALSE(best.intensity.events.has_value());
  EXPECT_EQ(best.intensity.samples, 1000);
  EXPECT_EQ(best.reference.turn_deg, 15);
  EXPECT_FALSE(best.contrast) << "the dataset's";
  const auto polarity = config::read<TrackConfig>(config::load(folder + "polarity.yaml"));
  EXPECT_EQ(polarity.method, TrackConfig::Method::kPolarity);
  EXPECT_EQ(polarity.polarity.events, 3000);
}

TEST(TrackConfig, PrintedConfigurationMeansTheSame) {
  const TrackConfig config = parse(
      "{reference: {planar_depth_m: 0.7, region_px: [1, 2, 30, 40]}, map: {thin: true},"
      " template: {splat: nearest, blur_size_px: 7}, align: {brightness: gain, hessian: "
      "samples}, motion: {prediction: constant_velocity, agility_px: 123}, initial_pose: [1, 2, 3, "
      "0, 0, 0, 1], seed: 9}");
  const std::string printed = config::print(config);
  EXPECT_EQ(config::print(parse(printed)), printed);
  const TrackConfig again = parse(printed);
  EXPECT_EQ(again.tracker.motion.agility_px, 123);
  EXPECT_EQ(again.initial_pose, config.initial_pose);
  EXPECT_EQ(again.reference.region_px, config.reference.region_px);
  EXPECT_EQ(again.tracker.templates.splat, TemplateOptions::Splat::kNearest);
}

TEST(TrackConfig, PrintedIntensityConfigurationMeansTheSame) {
  const TrackConfig config = parse(
      "{method: intensity, reference: {turn_deg: 7}, intensity: {events: 321, place_px: 0.4, "
      "blur_px: 0, contrast: 0.17}, motion: {prediction: constant_velocity, agility_share: 3}}");
  const std::string printed = config::print(config);
  EXPECT_EQ(config::print(parse(printed)), printed);
  const TrackConfig again = parse(printed);
  EXPECT_EQ(again.method, TrackConfig::Method::kIntensity);
  EXPECT_EQ(again.reference.turn_deg, 7);
  EXPECT_EQ(again.intensity.events, 321);
  EXPECT_EQ(again.intensity.place_px, 0.4);
  EXPECT_EQ(again.intensity.map.blur_px, 0);
  EXPECT_EQ(again.contrast, 0.17);
  EXPECT_EQ(again.tracker.motion.agility_share, 3);
}

TEST(TrackConfig, PrintedPolarityConfigurationMeansTheSame) {
  const TrackConfig config = parse(
      "{method: polarity, polarity: {events: 321, reversals: false, min_slope: 0.4}, motion: "
      "{prediction: constant_velocity}}");
  const std::string printed = config::print(config);
  EXPECT_EQ(config::print(parse(printed)), printed);
  const TrackConfig again = parse(printed);
  EXPECT_EQ(again.method, TrackConfig::Method::kPolarity);
  EXPECT_EQ(again.polarity.events, 321);
  EXPECT_EQ(again.polarity.min_slope, 0.4);
  EXPECT_FALSE(again.polarity.reversals);
}

struct Fault {
  std::string yaml;
  std::string place;
};

TEST(TrackConfig, FaultsNameTheirPlace) {
  const std::vector<Fault> faults{
      {"{sampels: 3}", "sampels"},
      {"{align: {sampels: 50}}", "did you mean 'samples'"},
      {"{align: {samples: 3}}", "align.samples"},
      {"{align: {iterations: 0}}", "align.iterations"},
      {"{align: {iterations: 2.5}}", "align.iterations"},
      {"{align: {brightness: linear}}", "align.brightness"},
      {"{align: {min_visible: 1.5}}", "align.min_visible"},
      {"{motion: {prediction: constant_velocity, gyro_sigma: 1}}", "prediction: imu"},
      {"{motion: {prediction: imu, gyro_sigma: 0}}", "motion.gyro_sigma"},
      {"{event_frame: {motion_compensation: true}}", "needs a motion.prediction"},
      {"{align: {levels: 0}}", "align.levels"},
      {"{align: {weights: cauchy}}", "align.weights"},
      {"{align: {selection: sparse}}", "align.selection"},
      {"{align: {converged_px: 0.1}}", "selection: random"},
      {"{align: {selection: dense, patch_px: 4}}", "selection: sparse_patches"},
      {"{align: {selection: semi_dense, steep_share: 0}}", "align.steep_share"},
      {"{align: {selection: sparse_patches, patch_px: 0}}", "align.patch_px"},
      {"{map: {min_gradient: -0.1}}", "map.min_gradient"},
      {"{map: {thin: 3}}", "map.thin"},
      {"{template: {blur_size_px: 4}}", "template.blur_size_px"},
      {"{template: {blur_size_px: 17}}", "template.blur_size_px"},
      {"{template: {blur_sigma_px: 0}}", "template.blur_sigma_px"},
      {"{template: {min_value: 0}}", "template.min_value"},
      {"{event_frame: {ratio: 0}}", "event_frame.ratio"},
      {"{event_frame: {min_events: 0}}", "event_frame.min_events"},
      {"{event_frame: {step: 0.5}}", "window: sliding"},
      {"{event_frame: {tau_share: 0.5}}", "kind: time_surface"},
      {"{event_frame: {kind: time_surface, tau_s: 0}}", "event_frame.tau_s"},
      {"{event_frame: {kind: time_surface, drawing: bilinear}}", "kind: binary"},
      {"{event_frame: {window: sliding, step: 1.5}}", "event_frame.step"},
      {"{reference: {planar_depth_m: 0}}", "reference.planar_depth_m"},
      {"{reference: {frame: -1}}", "reference.frame"},
      {"{reference: {region_px: [1, 2, 3]}}", "reference.region_px"},
      {"{motion: {prediction: none, agility_px: 100}}", "agility_px"},
      {"{frames: {samples: 100}}", "frames"},
      {"{method: frame}", "did you mean 'frames'"},
      {"{method: frames, frames: {samples: 3}}", "frames.samples"},
      {"{method: frames, frames: {levels: 9}}", "frames.levels"},
      {"{method: frames, frames: {exposure: 1}}", "exposure"},
      {"{method: frames, intensity: {events: 100}}", "intensity"},
      {"{method: intensity, intensity: {events: 0}}", "intensity.events"},
      {"{lost: {frames: 0}}", "lost.frames"},
      {"{method: levels}", "method"},
      {"{method: polarity}", "polarity needs a motion.prediction"},
      {"{method: polarity, polarity: {events: 0}}", "polarity.events"},
      {"{polarity: {events: 100}}", "polarity"},
      {"{intensity: {events: 500}}", "intensity"},
      {"{method: intensity, intensity: {events: 0}}", "intensity.events"},
      {"{method: intensity, intensity: {correction: 1.5}}", "intensity.correction"},
      {"{method: intensity, intensity: {contrast: 0}}", "intensity.contrast"},
      {"{method: intensity, intensity: {information: 0}}", "intensity.information"},
      {"{reference: {turn_deg: 0}}", "reference.turn_deg"},
      {"{motion: {prediction: none, agility_share: 1}}", "agility_share"},
      {"{motion: {prediction: constant_velocity, agility_share: -1}}", "motion.agility_share"},
      {"{initial_pose: [0, 0, 0]}", "initial_pose"},
      {"{seed: -1}", "seed"},
  };
  for (const Fault& fault : faults) {
    const std::string error = error_of([&] { return parse(fault.yaml); });
    EXPECT_THAT(error, HasSubstr("t.yaml")) << fault.yaml;
    EXPECT_THAT(error, HasSubstr(fault.place)) << fault.yaml;
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
