#pragma once

#include <optional>

#include "estimator/tracking/intensity_map.h"

namespace saccade {

/// How poses are found from the log intensity at each event.
struct IntensityOptions {
  IntensityMapOptions map;
  /// Per pose; by default 1000, times (width / 240 px)^1.5 on a wider sensor.
  std::optional<int> events;
  int samples = 1000;           ///< at most so many of them are aligned, evenly spread
  double pixels_per_event = 1;  ///< aligned beside them: pixels between their events
  double least_slope = 0.1;     ///< of the map where such a pixel looks [log units/px]
  bool half_step = true;        ///< a pixel is taken to have gone on by half a threshold
  int iterations = 4;           ///< of Gauss-Newton
  double noise = 0.05;          ///< deviation of a level from the map [log units]
  double place_px = 0.2;        ///< of the place where the map shows it, see EventChunk::Noise
  double correction = 0.15;     ///< least share by which a level is drawn to the map at each event
  double redraw_deg = 1.15;     ///< the map is drawn anew when the view has moved this far
  double inlier_drop = 0.75;    ///< lost below this share of the inlier ratio that is usual
  double silence_px = 2;        ///< lost where the camera should have moved so far without an event
  double information = 0.1;     ///< of that of independent residuals: neighbouring ones err alike
};

/// The part of a sensor's model that the tracker knows.
struct EventContrast {
  double on = 0.2, off = 0.2;  ///< thresholds [log units]
};

}  // namespace saccade
