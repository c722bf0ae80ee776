#include "simulator/sensor/noise/photoreceptor.h"

#include <algorithm>
#include <numbers>

#include "simulator/sensor/noise/radiance.h"

namespace saccade {

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
