#include "simulator/sensor/noise/photoreceptor.h"

#include <algorithm>
#include <numbers>

#include "core/config/fields.h"
#include "simulator/sensor/noise/radiance.h"

namespace saccade {

void describe(config::Fields& fields, BandwidthOptions& options) {
  fields
      .value("cutoff_hz", options.cutoff_hz,
             "Cutoff frequency of the photoreceptor at radiance 1, in hertz; it falls with the "
             "radiance. 0 disables the low pass.")
      .range(0, BandwidthOptions{}.max_cutoff_hz);
  fields.value("order", options.order, "Number of poles of the low pass: 1 or 2.").range(1, 2);
}

double PhotoreceptorFilter::cutoff_at(double radiance) const {
  const double brightness =
      (radiance + options_.dark_radiance) / (options_.bright_radiance + options_.dark_radiance);
  return std::min(options_.max_cutoff_hz, options_.cutoff_hz * brightness);
}

double PhotoreceptorFilter::cutoff_hz(double log_intensity) const {
  return cutoff_at(radiance_from_log(log_intensity, log_eps_));
}

double PhotoreceptorFilter::memory_s(double least) const {
  return kMemory / (2 * std::numbers::pi * cutoff_at(std::max(least, 0.0)));
}

FilteredPiece PhotoreceptorFilter::piece(const FilterState& state, const LinearPiece& input) const {
  const double cutoff = cutoff_hz(0.5 * (input.start + input.end));
  return {state, input, 2 * std::numbers::pi * cutoff, options_.order};
}

}  // namespace saccade
