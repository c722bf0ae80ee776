#include "simulator/sensor/sensor_parameters.h"

namespace saccade {
namespace {

/// use(parameter, option) for every pair of the same meaning: the one place where both are named.
template <class Parameters, class Options, class Use>
void for_each_parameter(Parameters& p, Options& options, const Use& use) {
  auto& noise = options.noise;
  use(p.contrast_on, options.contrast.on);
  use(p.contrast_off, options.contrast.off);
  use(p.log_eps, options.log_eps);
  use(p.mismatch_sigma, noise.mismatch.sigma);
  use(p.refractory_us, noise.refractory.period_us);
  use(p.leak_hz, noise.leak.rate_hz);
  use(p.shot_hz, noise.shot.rate_hz);
  use(p.cutoff_hz, noise.bandwidth.cutoff_hz);
  use(p.filter_order, noise.bandwidth.order);
  use(p.hot_fraction, noise.hot.fraction);
  use(p.hot_hz, noise.hot.rate_hz);
  use(p.hot_sigma, noise.hot.sigma);
}

}  // namespace

void apply(const SensorParameters& parameters, EventOptions& options) {
  for_each_parameter(parameters, options, [](const auto& parameter, auto& option) {
    if (parameter) option = *parameter;
  });
}

SensorParameters parameters_of(const EventOptions& options) {
  SensorParameters parameters;
  for_each_parameter(parameters, options,
                     [](auto& parameter, const auto& option) { parameter = option; });
  return parameters;
}

}  // namespace saccade
