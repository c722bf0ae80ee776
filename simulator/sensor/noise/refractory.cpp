#include "simulator/sensor/noise/refractory.h"

#include "core/config/fields.h"

namespace saccade {

void describe(config::Fields& fields, RefractoryOptions& options) {
  fields
      .value("period_us", options.period_us,
             "Time after an event in which a pixel cannot fire, in microseconds; at its end the "
             "reference is set to the signal. 0 disables it.")
      .range(0, 1e6);
}

}  // namespace saccade
