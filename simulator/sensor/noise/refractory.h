#pragma once

namespace saccade {
namespace config {
class Fields;
}

/// After an event the pixel cannot fire for the refractory period `period_us`; at its end the
/// reference is the signal of that time (the reset of the differencing amplifier; Lichtsteiner et
/// al. 2008). A ramp of slope s fires at 1 / (T + C / s).
struct RefractoryOptions {
  double period_us = 0;

  [[nodiscard]] bool on() const { return period_us > 0; }
};
void describe(config::Fields& fields, RefractoryOptions& options);

}  // namespace saccade
