#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/config/fields.h"

namespace saccade {

/// What is known of an event sensor (sensor.yaml): what `saccade calibrate` has found, or a person
/// has measured. nullopt: not known. The events' members are the keys of the same name of a
/// simulation's section `events`.
struct SensorParameters {
  std::optional<double> contrast_on, contrast_off;  ///< [log units]
  std::optional<double> log_eps;                    ///< in units of the frames' white
  std::optional<double> mismatch_sigma;             ///< of the thresholds, relative
  std::optional<double> refractory_us;
  std::optional<double> leak_hz;
  std::optional<double> shot_hz;
  std::optional<double> cutoff_hz;  ///< of the photoreceptor at radiance 1
  std::optional<int> filter_order;
  std::optional<double> hot_fraction, hot_hz, hot_sigma;
};

/// The contents of sensor.yaml.
struct SensorFile {
  int format_version = 1;
  std::string name;  ///< of the sensor
  SensorParameters events;
  /// The mean change of the log intensity from an event of a pixel to its next, which is more than
  /// the threshold where a pixel is blind in between: what an estimator that adds up thresholds
  /// should add [log units].
  std::optional<double> effective_contrast_on, effective_contrast_off;
  /// 95 % intervals by the name that messages give a parameter ("refractory.period_us").
  std::map<std::string, std::array<double, 2>> intervals;
  /// Rates of a pixel before what does not change [1/s], as they were counted.
  std::optional<double> noise_on_hz, noise_off_hz;
  /// Why a parameter is not known, or what its value rests on, by the same names.
  std::map<std::string, std::string> remarks;

  /// What estimators should take for the thresholds: the effective ones, else the nominal ones.
  [[nodiscard]] std::optional<double> estimator_contrast_on() const {
    return effective_contrast_on ? effective_contrast_on : events.contrast_on;
  }
  [[nodiscard]] std::optional<double> estimator_contrast_off() const {
    return effective_contrast_off ? effective_contrast_off : events.contrast_off;
  }
};

void describe(config::Fields& fields, SensorParameters& parameters);
void describe(config::Fields& fields, SensorFile& sensor);

/// InputError with file:line; another format_version than 1 is an error.
[[nodiscard]] SensorFile read_sensor_file(const std::filesystem::path& file);
/// With the help of every key behind it.
void write_sensor_file(const std::filesystem::path& file, const SensorFile& sensor);

}  // namespace saccade
