#include "estimator/run/sensor_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/tracking/track_config.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr const char* kSensor =
    "format_version: 1\n"
    "events: {contrast_on: 0.35, contrast_off: 0.14, noise: {mismatch: {sigma: 0.2}}}\n"
    "estimators: {contrast_on: 0.4}\n";

template <class Config>
Config read_with_sensor(const std::string& more) {
  const TemporaryFolder folder;
  folder.write("sensor.yaml", kSensor);
  return config::read<Config>(
      config::load(folder.write("config.yaml", "sensor: sensor.yaml\n" + more)));
}

TEST(SensorInput, GivesTheTrackerThresholdsAndMismatch) {
  const auto config = read_with_sensor<TrackConfig>("method: intensity\n");
  EXPECT_EQ(config.contrast_on, 0.4);  // the effective one
  EXPECT_EQ(config.contrast_off, 0.14);
  EXPECT_EQ(config.intensity.mismatch_sigma, 0.2);
}

TEST(SensorInput, GivesWayToStatedKeys) {
  const auto config = read_with_sensor<TrackConfig>(
      "method: intensity\nintensity: {contrast_on: 0.3, mismatch_sigma: 0.1}\n");
  EXPECT_EQ(config.contrast_on, 0.3);
  EXPECT_EQ(config.contrast_off, 0.14);
  EXPECT_EQ(config.intensity.mismatch_sigma, 0.1);
}

TEST(SensorInput, IsPartOfTheResolvedConfiguration) {
  const std::string text = config::print(read_with_sensor<TrackConfig>("method: intensity\n"));
  EXPECT_THAT(text, HasSubstr("sensor.yaml"));
  EXPECT_THAT(text, HasSubstr("contrast_on: 0.4"));
}

TEST(SensorInput, GivesReconstructionThresholdsAndTheErrorOfAnEvent) {
  const auto config = read_with_sensor<ReconstructionConfig>("method: equations\n");
  EXPECT_EQ(config.contrast_on, 0.4);
  EXPECT_EQ(config.contrast_off, 0.14);
  // 0.2 of the mean threshold 0.27 is less than the method's own 0.075.
  EXPECT_FLOAT_EQ(static_cast<float>(config.observations().event_sigma), 0.075F);
  const auto stated =
      read_with_sensor<ReconstructionConfig>("method: equations\ncontrast_on: 1.2\n");
  EXPECT_EQ(stated.contrast_on, 1.2);
}

TEST(SensorInput, GivesOdometryTheThresholdsOfItsImages) {
  const auto config = read_with_sensor<OdometryConfig>("method: edges\n");
  EXPECT_EQ(config.odometry.mapping.reconstruction.contrast_on, 0.4);
  EXPECT_EQ(config.odometry.mapping.reconstruction.contrast_off, 0.14);
  const auto stated =
      read_with_sensor<OdometryConfig>("method: edges\nmapping: {contrast_off: 0.3}\n");
  EXPECT_EQ(stated.odometry.mapping.reconstruction.contrast_off, 0.3);
}

TEST(SensorInput, ThatIsMissingIsAnErrorWithItsPlace) {
  const TemporaryFolder folder;
  const auto file = folder.write("config.yaml", "method: intensity\nsensor: nowhere.yaml\n");
  const std::string error = error_of([&] { return config::read<TrackConfig>(config::load(file)); });
  EXPECT_THAT(error, HasSubstr("config.yaml:2"));
  EXPECT_THAT(error, HasSubstr("nowhere.yaml"));
}

}  // namespace
}  // namespace saccade
