#include "simulator/sensor/sensor_parameters.h"

#include <gtest/gtest.h>

#include "core/config/config.h"
#include "simulator/simulation_config.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

using testing::TemporaryFolder;

constexpr const char* kSensor =
    "format_version: 1\n"
    "events:\n"
    "  contrast_on: 0.35\n"
    "  contrast_off: 0.14\n"
    "  noise: {refractory: {period_us: 1900}}\n";

constexpr const char* kScene =
    "scene: {meshes: [{file: scene.obj}]}\n"
    "trajectory: {source: slider, duration_s: 1}\n"
    "sensor: sensor.yaml\n";

SimulationConfig read_config(const std::string& more) {
  const TemporaryFolder folder;
  folder.write("sensor.yaml", kSensor);
  folder.write("scene.obj", "");
  return config::read<SimulationConfig>(
      config::load(folder.write("simulation.yaml", kScene + more)));
}

TEST(SensorParameters, AreTheDefaultsOfEvents) {
  const EventOptions events = read_config("").events;
  EXPECT_EQ(events.contrast.on, 0.35);
  EXPECT_EQ(events.contrast.off, 0.14);
  EXPECT_EQ(events.noise.refractory.period_us, 1900);
  EXPECT_FALSE(events.noise.shot.on());
}

TEST(SensorParameters, LeaveToThePresetWhatTheyDoNotKnow) {
  const EventOptions events = read_config("events: {preset: davis240c}\n").events;
  EXPECT_EQ(events.contrast.on, 0.35);
  EXPECT_EQ(events.noise.refractory.period_us, 1900);
  EXPECT_EQ(events.noise.leak.rate_hz, sensor_preset(SensorModel::kDavis240c).noise.leak.rate_hz);
}

TEST(SensorParameters, GiveWayToStatedKeys) {
  const EventOptions events =
      read_config("events: {contrast_on: 0.2, noise: {refractory: {period_us: 0}}}\n").events;
  EXPECT_EQ(events.contrast.on, 0.2);
  EXPECT_EQ(events.contrast.off, 0.14);
  EXPECT_EQ(events.noise.refractory.period_us, 0);
}

TEST(SensorParameters, OfTheFirstCameraAreTheDefaultsOfARig) {
  const SimulationConfig config = read_config(
      "events: {contrast_on: 0.2}\n"
      "rig: [{T_camera0_camera: [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]\n");
  ASSERT_EQ(config.rig.size(), 1U);
  EXPECT_EQ(config.rig[0].events.contrast.on, 0.2);
  EXPECT_EQ(config.rig[0].events.contrast.off, 0.14);
}

TEST(SensorParameters, OfOptionsMakeTheSameOptionsAgain) {
  EventOptions options;
  options.noise = sensor_preset(SensorModel::kDvxplorer).noise;
  options.contrast = {0.31, 0.17};
  options.log_eps = 0.02;
  EventOptions again;
  apply(parameters_of(options), again);
  EXPECT_EQ(again.contrast.on, 0.31);
  EXPECT_EQ(again.contrast.off, 0.17);
  EXPECT_EQ(again.log_eps, 0.02);
  EXPECT_EQ(again.noise.mismatch.sigma, options.noise.mismatch.sigma);
  EXPECT_EQ(again.noise.bandwidth.cutoff_hz, options.noise.bandwidth.cutoff_hz);
  EXPECT_EQ(again.noise.bandwidth.order, options.noise.bandwidth.order);
  EXPECT_EQ(again.noise.hot.rate_hz, options.noise.hot.rate_hz);
}

}  // namespace
}  // namespace saccade
