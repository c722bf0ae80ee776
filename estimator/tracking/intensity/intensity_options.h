#pragma once

#include <optional>

#include "core/config/fields.h"
#include "estimator/tracking/intensity_map.h"

namespace saccade {

/// How poses are found from the log intensity at each event.
struct IntensityOptions {
  /// Edges attract from further away, and the pixels beside them are shown what they never saw: less
  /// than IntensityMap::kEdgeBlur_px is a better bargain (docs/tracking.md).
  double map_blur_px = 0.5;
  std::optional<int> events;  ///< per pose; by default as many as some pixels and motion need
  double no_event_ratio = 1;  ///< no-event constraints per pixel with events
  /// A pixel between its events is taken to have gone on by half a threshold: it may be anywhere
  /// within one, and mostly keeps its direction.
  bool half_threshold = true;
  std::optional<double>
      mismatch_sigma;  ///< of the thresholds, relative; by default from the events
  double redraw_deg =
      1.15;  ///< the map is rendered anew when image points have moved by fx times this
};

void describe(config::Fields& fields, IntensityOptions& options);

}  // namespace saccade
