#pragma once

#include <optional>

#include "core/config/fields.h"
#include "core/io/dataset/dataset.h"

namespace saccade {

/// Contrast thresholds C+ and C- of the event pixels, > 0 [log units].
struct ContrastThresholds {
  double on = 0, off = 0;
};

/// Describes the keys `contrast_on` and `contrast_off` of a configuration.
void describe_contrast(config::Fields& fields, std::optional<double>& on,
                       std::optional<double>& off);

/// Those of a configuration, else the dataset's. Throws InputError if neither states them.
[[nodiscard]] ContrastThresholds contrast_thresholds(const std::optional<double>& on,
                                                     const std::optional<double>& off,
                                                     const Dataset& dataset);

}  // namespace saccade
