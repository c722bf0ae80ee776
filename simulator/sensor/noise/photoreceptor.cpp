#include "simulator/sensor/noise/photoreceptor.h"

#include <algorithm>
#include <numbers>

#include "simulator/sensor/noise/radiance.h"

namespace saccade {

double PhotoreceptorFilter::cutoff_hz(double log_intensity) const {
  const double brightness = (radiance_from_log(log_intensity, log_eps_) + options_.dark_radiance) /
                            (options_.bright_radiance + options_.dark_radiance);
  return std::min(options_.max_cutoff_hz, options_.cutoff_hz * brightness);
}

FilteredPiece PhotoreceptorFilter::piece(const FilterState& state, const LinearPiece& input) const {
  const double cutoff = cutoff_hz(0.5 * (input.start + input.end));
  return {state, input, 2 * std::numbers::pi * cutoff, options_.order};
}

}  // namespace saccade
