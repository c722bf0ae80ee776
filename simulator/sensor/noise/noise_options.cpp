#include "simulator/sensor/noise/noise_options.h"

#include <algorithm>

namespace saccade {
namespace {

constexpr double kLongest_us = 1e6;
constexpr double kHighestNoise_hz = 1e5;
constexpr double kHighestRadiance = 1e6;

void describe_model(config::Fields& fields, MismatchOptions& options) {
  fields
      .value("sigma", options.sigma,
             "standard deviation of a pixel's thresholds as a share of the nominal ones")
      .range(0, 0.5);
}

void describe_model(config::Fields& fields, RefractoryOptions& options) {
  fields.value("period_us", options.period_us, "blind time after an event [us]")
      .range(0, kLongest_us);
}

void describe_model(config::Fields& fields, LeakOptions& options) {
  fields.value("rate_hz", options.rate_hz, "ON events of a pixel before a static scene [1/s]")
      .range(0, kHighestNoise_hz);
  fields.value("sigma", options.sigma, "spread of the pixels' rates as a share of rate_hz")
      .range(0, 1);
}

void describe_model(config::Fields& fields, ShotOptions& options) {
  fields.value("rate_hz", options.rate_hz, "events of a pixel in the dark, ON and OFF [1/s]")
      .range(0, kHighestNoise_hz);
  fields.value("bright_share", options.bright_share, "of the rate, left at bright_radiance")
      .range(0, 1);
  fields.value("bright_radiance", options.bright_radiance, "radiance at which the rate is least")
      .range(1e-6, kHighestRadiance);
}

void describe_model(config::Fields& fields, BandwidthOptions& options) {
  fields.value("cutoff_hz", options.cutoff_hz, "cutoff at bright_radiance; 0: no filter [Hz]")
      .range(0, 1e6);
  fields.value("order", options.order, "poles: 1 or 2");
  fields.value("bright_radiance", options.bright_radiance, "radiance to which cutoff_hz belongs")
      .range(1e-6, kHighestRadiance);
  fields.value("dark_radiance", options.dark_radiance, "radiance that the dark current stands for")
      .range(1e-6, kHighestRadiance);
  fields.value("max_cutoff_hz", options.max_cutoff_hz, "cutoff however bright it is [Hz]")
      .range(1e-3, 1e7);
  fields.expect(options.order == 1 || options.order == 2, "order", "must be 1 or 2");
  fields.expect(options.cutoff_hz <= options.max_cutoff_hz, "cutoff_hz",
                "must not be above max_cutoff_hz");
}

void describe_model(config::Fields& fields, HotOptions& options) {
  fields.value("fraction", options.fraction, "share of the pixels that are hot").range(0, 1);
  fields.value("rate_hz", options.rate_hz, "median rate of a hot pixel [1/s]")
      .range(0, kHighestNoise_hz);
  fields.value("sigma", options.sigma, "standard deviation of the rate's natural logarithm")
      .range(0, 1);
}

void describe_model(config::Fields& fields, LatencyOptions& options) {
  fields.value("mean_us", options.mean_us, "of every event [us]").range(0, kLongest_us);
  fields.value("intensity_us", options.intensity_us, "added at radiance 1, more where darker [us]")
      .range(0, kLongest_us);
  fields.value("dark_radiance", options.dark_radiance, "radiance that the dark current stands for")
      .range(1e-6, kHighestRadiance);
  fields.value("jitter_us", options.jitter_us, "standard deviation [us]").range(0, kLongest_us);
}

void describe_model(config::Fields& fields, ReadoutOptions& options) {
  fields.value("rate_hz", options.rate_hz, "events per second over the bus; 0: no limit")
      .range(0, 1e12);
  fields.value("rows", options.rows, "all waiting events of a row leave together");
  fields.value("capacity", options.capacity, "events that can wait, more are lost; 0: no limit")
      .at_least(0);
  fields.expect(options.rate_hz > 0 || (!options.rows && options.capacity == 0), "rate_hz",
                "must be above 0 for rows and capacity");
}

template <auto kMember>
constexpr NoiseModel model(std::string_view name, std::string_view help) {
  return {name, help,
          [](config::Fields& fields, NoiseOptions& options) {
            describe_model(fields, options.*kMember);
          },
          [](const NoiseOptions& options) { return (options.*kMember).on(); }};
}

constexpr NoiseModel kModels[] = {
    model<&NoiseOptions::mismatch>("mismatch", "thresholds that differ between pixels"),
    model<&NoiseOptions::refractory>("refractory", "blind time after an event"),
    model<&NoiseOptions::leak>("leak", "falling reference"),
    model<&NoiseOptions::shot>("shot", "shot noise that falls with the radiance"),
    model<&NoiseOptions::bandwidth>("bandwidth", "low pass of the photoreceptor"),
    model<&NoiseOptions::hot>("hot", "pixels that fire by themselves"),
    model<&NoiseOptions::latency>("latency", "delay and jitter of the time stamps"),
    model<&NoiseOptions::readout>("readout", "finite rate of the bus"),
};

}  // namespace

std::span<const NoiseModel> noise_models() { return kModels; }

bool NoiseOptions::any() const {
  return std::ranges::any_of(kModels, [this](const NoiseModel& m) { return m.is_on(*this); });
}

void describe(config::Fields& fields, NoiseOptions& options) {
  for (const NoiseModel& noise : kModels)
    fields.group(
        noise.name, [&](config::Fields& section) { noise.describe(section, options); }, noise.help);
}

}  // namespace saccade
