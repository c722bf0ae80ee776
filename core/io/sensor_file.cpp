#include "core/io/sensor_file.h"

#include "core/config/config.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

void describe_noise(config::Fields& fields, SensorParameters& p) {
  using config::Fields;
  fields.group(
      "mismatch",
      [&](Fields& f) {
        f.value("sigma", p.mismatch_sigma,
                "Standard deviation of the pixels' thresholds, as a fraction of the nominal one.")
            .range(0, 0.5);
      },
      "Thresholds that differ from pixel to pixel.");
  fields.group(
      "refractory",
      [&](Fields& f) {
        f.value("period_us", p.refractory_us,
                "Time after an event in which a pixel cannot fire, in microseconds.")
            .range(0, 1e6);
      },
      "Blind time of a pixel.");
  fields.group(
      "leak",
      [&](Fields& f) {
        f.value("rate_hz", p.leak_hz, "ON events of a pixel before a static scene, per second.")
            .range(0, 1e5);
      },
      "Leaking reference.");
  fields.group(
      "shot",
      [&](Fields& f) {
        f.value("rate_hz", p.shot_hz, "Noise events of a pixel in the dark, per second.")
            .range(0, 1e5);
      },
      "Shot noise.");
  fields.group(
      "bandwidth",
      [&](Fields& f) {
        f.value("cutoff_hz", p.cutoff_hz, "Cutoff of the photoreceptor at radiance 1, in hertz.")
            .range(0, 1e5);
        f.value("order", p.filter_order, "Number of poles of the low pass.").range(1, 2);
      },
      "Low pass of the photoreceptor.");
  fields.group(
      "hot",
      [&](Fields& f) {
        f.value("fraction", p.hot_fraction, "Fraction of the pixels that are hot.").range(0, 1);
        f.value("rate_hz", p.hot_hz, "Events of a hot pixel per second, geometric mean.")
            .range(0, 1e5);
        f.value("sigma", p.hot_sigma, "Standard deviation of the logarithm of these rates.")
            .range(0, 1);
      },
      "Hot pixels.");
}

}  // namespace

void describe(config::Fields& fields, SensorParameters& p) {
  fields
      .value("contrast_on", p.contrast_on, "Increase of the log intensity that fires an ON event.")
      .range(0.001, 10);
  fields
      .value("contrast_off", p.contrast_off,
             "Decrease of the log intensity that fires an OFF event.")
      .range(0.001, 10);
  fields
      .value("log_eps", p.log_eps,
             "Offset eps of the log intensity ln(eps + I) for which the thresholds hold.")
      .range(1e-9, 1);
  fields.group(
      "noise", [&](config::Fields& f) { describe_noise(f, p); }, "Imperfections of the sensor.");
}

void describe(config::Fields& fields, SensorFile& sensor) {
  using config::Fields;
  fields.value("format_version", sensor.format_version, "Layout of this file.")
      .required()
      .range(1, 1);
  fields.value("name", sensor.name, "Name of the sensor.");
  fields.section("events", sensor.events,
                 "Keys of a simulation's section events; ~ is not known, and leaves the default.");
  fields.group(
      "estimators",
      [&](Fields& f) {
        f.value("contrast_on", sensor.effective_contrast_on,
                "Mean increase of the log intensity since the event before an ON event.")
            .above(0);
        f.value("contrast_off", sensor.effective_contrast_off,
                "Mean decrease of the log intensity since the event before an OFF event.")
            .above(0);
      },
      "What estimators take for the thresholds; ~ takes those of events.");
  fields.group(
      "measured",
      [&](Fields& f) {
        f.value("noise_on_hz", sensor.noise_on_hz, "ON events of a quiet pixel per second.")
            .at_least(0);
        f.value("noise_off_hz", sensor.noise_off_hz, "OFF events of a quiet pixel per second.")
            .at_least(0);
      },
      "Rates that were counted, whatever causes them.");
  fields.value("intervals", sensor.intervals, "95 % intervals of what was found.");
  fields.value("remarks", sensor.remarks, "What a value rests on, or why there is none.");
}

SensorFile read_sensor_file(const std::filesystem::path& file) {
  return config::read<SensorFile>(config::load(file));
}

void write_sensor_file(const std::filesystem::path& file, const SensorFile& sensor) {
  write_atomically(file, config::print_documented(sensor));
}

}  // namespace saccade
