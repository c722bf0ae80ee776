#pragma once

#include <optional>

#include "core/config/fields.h"
#include "estimator/tracking/intensity_map.h"

namespace saccade {

/// How poses are found from the log intensity at each event.
struct IntensityOptions {
  double map_blur_px = IntensityMap::kEdgeBlur_px;
  /// Per pose; by default 1000, times (width / 240 px)^1.5 on a wider sensor.
  std::optional<int> events;
  int samples = 1000;         ///< at most so many events of a pose are aligned, evenly spread
  double no_event_ratio = 1;  ///< no-event constraints per aligned event
  /// A pixel between its events is taken to have gone on by half a threshold: it may be anywhere
  /// within one, and mostly keeps its direction.
  bool half_threshold = true;
  double correction_fraction = 0.15;
  double redraw_deg =
      1.15;  ///< the map is rendered anew when image points have moved by fx times this
};

void describe(config::Fields& fields, IntensityOptions& options);

/// The part of a sensor's model that the tracker knows.
struct EventContrast {
  double on = 0.2, off = 0.2;  ///< thresholds [log units]
};

}  // namespace saccade
