#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/dataset/dataset.h"

namespace saccade {

/// Contrast thresholds C+ and C- of the event pixels, > 0 [log units].
struct ContrastThresholds {
  double on = 0, off = 0;
  bool is_found = false;  ///< from the events, up to a common factor: nobody states them
};

/// Describes the keys `contrast_on` and `contrast_off` of a configuration.
void describe_contrast(config::Fields& fields, std::optional<double>& on,
                       std::optional<double>& off);

/// Those of a configuration, else the dataset's. Where neither states one, the light is taken to be
/// as much at the end as at the beginning, so that N+ C+ = N- C- of the numbers of `events`; where
/// none is stated, C+ is 0.2, as the scale of the image is not known.
[[nodiscard]] ContrastThresholds contrast_thresholds(const std::optional<double>& on,
                                                     const std::optional<double>& off,
                                                     const Dataset& dataset,
                                                     std::span<const Event> events);

/// ", C+ / C- = 1.29 by the balance of the events", or nothing where both are stated.
[[nodiscard]] std::string found_text(const ContrastThresholds& thresholds);

}  // namespace saccade
