#pragma once

namespace saccade {

/// The part of a sensor's model that a tracker knows.
struct EventContrast {
  double on = 0.2, off = 0.2;  ///< thresholds [log units]
};

}  // namespace saccade
