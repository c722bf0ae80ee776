#pragma once

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/event_file.h"
#include "simulator/sensor/crossing.h"

namespace saccade {

/// The event sensor (section `events`).
struct EventOptions {
  Contrast contrast;
  double log_eps = 1e-3;         ///< eps of L = ln(eps + I)
  double time_tolerance_us = 1;  ///< width of the final bracket around every crossing
  int samples_per_pixel = 1;     ///< rays whose mean radiance a pixel sees: 1, 4 or 16
  TimestampUnit timestamp_unit = TimestampUnit::kMicroseconds;
  double max_step_px = 0.5;  ///< image motion between two looks at a pixel

  [[nodiscard]] TimeNs timestamp_step_ns() const {
    return timestamp_unit == TimestampUnit::kMicroseconds ? 1000 : 1;
  }
};

void describe(config::Fields& fields, EventOptions& options);

}  // namespace saccade
