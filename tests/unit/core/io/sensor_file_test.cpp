#include "core/io/sensor_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

TEST(SensorFile, ReadsBackWhatItWrote) {
  SensorFile sensor;
  sensor.name = "davis240c";
  sensor.events.contrast_on = 0.35;
  sensor.events.contrast_off = 0.14;
  sensor.events.refractory_us = 1900;
  sensor.events.filter_order = 2;
  sensor.events.hot_sigma = 0.25;
  sensor.effective_contrast_on = 0.42;
  sensor.noise_off_hz = 0.0125;
  sensor.intervals["contrast_on"] = {0.33, 0.37};
  sensor.remarks["leak.rate_hz"] = "not told: too short";
  const TemporaryFolder folder;
  write_sensor_file(folder.path() / "sensor.yaml", sensor);
  const SensorFile read = read_sensor_file(folder.path() / "sensor.yaml");
  EXPECT_EQ(read.name, "davis240c");
  EXPECT_EQ(read.events.contrast_on, 0.35);
  EXPECT_EQ(read.events.contrast_off, 0.14);
  EXPECT_EQ(read.events.refractory_us, 1900);
  EXPECT_EQ(read.events.filter_order, 2);
  EXPECT_EQ(read.events.hot_sigma, 0.25);
  EXPECT_EQ(read.effective_contrast_on, 0.42);
  EXPECT_EQ(read.noise_off_hz, 0.0125);
  EXPECT_EQ(read.intervals, sensor.intervals);
  EXPECT_EQ(read.remarks, sensor.remarks);
}

TEST(SensorFile, WhatIsNotKnownStaysUnknown) {
  const TemporaryFolder folder;
  write_sensor_file(folder.path() / "sensor.yaml", {});
  const SensorFile read = read_sensor_file(folder.path() / "sensor.yaml");
  EXPECT_FALSE(read.events.contrast_on);
  EXPECT_FALSE(read.events.cutoff_hz);
  EXPECT_FALSE(read.events.filter_order);
  EXPECT_FALSE(read.estimator_contrast_on());
}

TEST(SensorFile, EstimatorsTakeTheNominalThresholdsWithoutEffectiveOnes) {
  SensorFile sensor;
  sensor.events.contrast_on = 0.3;
  sensor.events.contrast_off = 0.2;
  sensor.effective_contrast_off = 0.25;
  EXPECT_EQ(sensor.estimator_contrast_on(), 0.3);
  EXPECT_EQ(sensor.estimator_contrast_off(), 0.25);
}

TEST(SensorFile, NamesThePlaceOfAMistakeAndTheNearestKey) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("sensor.yaml", "format_version: 1\nevents:\n  contrast_onn: 0.3\n");
  const std::string error = error_of([&] { return read_sensor_file(file); });
  EXPECT_THAT(error, HasSubstr("sensor.yaml:3"));
  EXPECT_THAT(error, HasSubstr("contrast_on"));
}

}  // namespace
}  // namespace saccade
