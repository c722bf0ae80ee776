#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "estimator/tracking/event_contrast.h"

namespace saccade {

/// The contrast thresholds of a sensor for which nobody states them, from what the map shows at its
/// events: from one measured level of a pixel to the next, a events of one polarity higher or lower,
/// the map's log intensity changes by dL = a C, and
///   C^2 = sum w dL^2 / sum w a^2.
/// That is the reduced major axis: both sides err, dL by the poses and a by what pixels miss or fire
/// without cause, and the regression of one on the other is too low or too high (measured: 0.16 in
/// place of 0.2, this 0.18). It is an effective threshold: that of a pixel which is blind for a while
/// after an event holds what it missed. The poses at which the map is read must come from elsewhere:
/// those of a tracker that uses the thresholds agree with any, and shrink both from step to step.
class ThresholdEstimator {
 public:
  /// What thresholds are expected to be before anything is known [log units]: those of cameras in use
  /// lie between 0.1 and 1.
  static constexpr EventContrast kExpected{0.3, 0.3};

  /// Of a sensor of so many pixels.
  explicit ThresholdEstimator(std::size_t pixels);

  /// The events that follow make up one level.
  void begin_level(std::size_t pixel) { pixels_[pixel].level = {}; }
  void add_event(std::size_t pixel, int polarity);
  /// The map shows `log_intensity` at the level's mean event; `weight` in 0..1.
  void measure(std::size_t pixel, float log_intensity, float weight);
  /// The last level of the pixel is not known.
  void forget(std::size_t pixel) { pixels_[pixel] = {}; }

  [[nodiscard]] EventContrast contrast() const;

 private:
  struct Counts {
    float on = 0, off = 0;
  };
  struct Level {
    Counts sum;  ///< over its events, of the counts at each
    float events = 0;
  };
  struct Pixel {
    float log_intensity = std::numeric_limits<float>::quiet_NaN();  ///< at the last level
    Counts since;                                                   ///< it
    Level level;                                                    ///< the next one
  };

  std::vector<Pixel> pixels_;
  /// Of one polarity.
  struct Sums {
    double changes, events;  ///< w dL^2, w a^2
    [[nodiscard]] double threshold() const;
  };
  Sums on_, off_;
};

}  // namespace saccade
