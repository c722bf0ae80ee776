#include "simulator/sensor/noise/noise_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "simulator/sensor/event_options.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

EventOptions read(const std::string& yaml) {
  return config::read<EventOptions>(config::parse(yaml, "events.yaml", "/data"));
}

TEST(NoiseOptions, AreAllOffByDefault) {
  EXPECT_FALSE(EventOptions{}.noise.any());
  EXPECT_FALSE(read("preset: ideal").noise.any());
  for (const NoiseModel& model : noise_models()) EXPECT_FALSE(model.is_on({})) << model.name;
}

TEST(NoiseOptions, PresetsSwitchOnEveryModel) {
  for (const char* name : {"davis240c", "davis346", "dvxplorer"}) {
    const EventOptions options = read(std::string("preset: ") + name);
    for (const NoiseModel& model : noise_models())
      EXPECT_TRUE(model.is_on(options.noise)) << name << " " << model.name;
    EXPECT_NO_THROW(config::check(options));
  }
}

TEST(NoiseOptions, StatedKeysOverrideThePresetWhereverTheyStand) {
  const EventOptions options = read(
      "contrast_on: 0.3\nnoise: {leak: {rate_hz: 0}, readout: {rows: false}}\npreset: davis240c");
  const SensorPreset preset = sensor_preset(SensorModel::kDavis240c);
  EXPECT_EQ(options.contrast.on, 0.3);
  EXPECT_EQ(options.contrast.off, preset.contrast.off);
  EXPECT_FALSE(options.noise.leak.on());
  EXPECT_EQ(options.noise.leak.sigma, preset.noise.leak.sigma);
  EXPECT_FALSE(options.noise.readout.rows);
  EXPECT_EQ(options.noise.readout.rate_hz, preset.noise.readout.rate_hz);
}

TEST(NoiseOptions, PrintedPresetReadsBackToTheSameValues) {
  const EventOptions stated = read("preset: dvxplorer\nnoise: {bandwidth: {order: 2}}");
  const std::string printed = config::print(stated);
  EXPECT_THAT(printed, HasSubstr("dvxplorer"));
  EXPECT_EQ(config::print(read(printed)), printed);
}

TEST(NoiseOptions, ErrorsNameTheKey) {
  const std::pair<const char*, const char*> cases[] = {
      {"mismatch: {sigma: -0.1}", "noise.mismatch.sigma"},
      {"mismatch: {sigma_on: 0.1}", "sigma_on"},
      {"refractory: {period_us: -1}", "noise.refractory.period_us"},
      {"leak: {rate_hz: fast}", "noise.leak.rate_hz"},
      {"shot: {rate_hz: 2e5}", "noise.shot.rate_hz"},
      {"bandwidth: {cutoff_hz: 100, order: 3}", "noise.bandwidth.order"},
      {"bandwidth: {cutoff_hz: 2e5}", "noise.bandwidth.cutoff_hz"},
      {"hot: {fraction: 2}", "noise.hot.fraction"},
      {"latency: {jitter_us: .inf}", "noise.latency.jitter_us"},
      {"readout: {capacity: 10}", "noise.readout.rate_hz"},
      {"readout: {rate_hz: 10, capacity: -1}", "noise.readout.capacity"},
      {"readouts: {rate_hz: 10}", "readout"},
  };
  for (const auto& [yaml, key] : cases) {
    const std::string whole = std::string("noise: {") + yaml + "}";
    const std::string error = error_of([&] { static_cast<void>(read(whole)); });
    EXPECT_THAT(error, HasSubstr("events.yaml:1")) << yaml;
    EXPECT_THAT(error, HasSubstr(key)) << yaml;
  }
}

}  // namespace
}  // namespace saccade
