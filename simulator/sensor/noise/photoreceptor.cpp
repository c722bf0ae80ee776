#include "simulator/sensor/noise/photoreceptor.h"

#include <numbers>

#include "core/config/fields.h"

namespace saccade {

void describe(config::Fields& fields, BandwidthOptions& options) {
  fields
      .value("cutoff_hz", options.cutoff_hz,
             "Cutoff frequency of the photoreceptor at radiance 1, in hertz; it falls with the "
             "radiance. 0 disables the low pass.")
      .range(0, BandwidthOptions{}.max_cutoff_hz);
  fields.value("order", options.order, "Number of poles of the low pass: 1 or 2.").range(1, 2);
}

PhotoreceptorFilter::PhotoreceptorFilter(const BandwidthOptions& options, double log_eps)
    : options_(options),
      log_eps_(log_eps),
      rate_per_radiance_(2 * std::numbers::pi * options.cutoff_hz /
                         (options.bright_radiance + options.dark_radiance)),
      max_rate_(2 * std::numbers::pi * options.max_cutoff_hz) {}

double PhotoreceptorFilter::cutoff_hz(double log_intensity) const {
  return rate_at(radiance_from_log(log_intensity, log_eps_)) / (2 * std::numbers::pi);
}

double PhotoreceptorFilter::memory_s(double least) const {
  return kMemory / rate_at(std::max(least, 0.0));
}

}  // namespace saccade
