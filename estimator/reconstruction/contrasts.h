#pragma once

#include <optional>

#include "core/io/dataset/dataset.h"

namespace saccade {

/// Thresholds of the event pixels [log units].
struct Contrasts {
  double on = 0, off = 0;
};

/// Those of a configuration (keys contrast_on and contrast_off), else the dataset's. Throws
/// InputError where neither states them.
[[nodiscard]] Contrasts contrasts(const std::optional<double>& on, const std::optional<double>& off,
                                  const Dataset& dataset);

}  // namespace saccade
