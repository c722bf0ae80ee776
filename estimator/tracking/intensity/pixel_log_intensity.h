#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/event.h"

namespace saccade {

/// The log intensity at which each pixel of an event camera fired last: its first value plus the
/// thresholds of its events. At the instant of an event it is exact for an ideal pixel; that of a
/// real one drifts (thresholds that differ, leak, noise), so it is corrected towards the map: the
/// first times fully, then ever less, down to a constant fraction (a running mean that forgets).
class PixelLogIntensity {
 public:
  /// Thresholds of an ON and an OFF event [log units], and the least fraction of a correction,
  /// 0..1.
  PixelLogIntensity(int width, int height, double contrast_on, double contrast_off,
                    double correction)
      : width_(width),
        on_(static_cast<float>(contrast_on)),
        off_(static_cast<float>(contrast_off)),
        correction_(static_cast<float>(correction)),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  [[nodiscard]] std::size_t index(const Event& event) const {
    return static_cast<std::size_t>(event.y) * static_cast<std::size_t>(width_) + event.x;
  }

  /// No pixel is known.
  void reset() { std::fill(pixels_.begin(), pixels_.end(), Pixel{}); }
  /// Sets a pixel, with the confidence of so many corrections.
  void set(std::size_t i, float log_intensity, float corrections) {
    pixels_[i] = {log_intensity, corrections, 0, 0};
  }

  void prefetch(std::size_t i) const { __builtin_prefetch(&pixels_[i]); }
  /// Takes an event in; returns the log intensity that its pixel has reached.
  float add_event(std::size_t i, int polarity) {
    Pixel& pixel = pixels_[i];
    pixel.half_threshold = 0.5F * (polarity > 0 ? on_ : -off_);
    pixel.log_intensity += 2 * pixel.half_threshold;
    return pixel.log_intensity;
  }

  /// At the pixel's last event.
  [[nodiscard]] float at_last_event(std::size_t i) const { return pixels_[i].log_intensity; }
  /// Between its events a pixel is within a threshold of its last value, and most likely half of
  /// one further in the direction of its last event.
  [[nodiscard]] float between_events(std::size_t i) const {
    return pixels_[i].log_intensity + pixels_[i].half_threshold;
  }

  /// 0 for an unknown pixel, towards 1 for one that has been corrected often.
  [[nodiscard]] float confidence(std::size_t i) const {
    return pixels_[i].corrections / (pixels_[i].corrections + 1);
  }

  /// The value of add_event() was `excess` above the map. Corrections of the same pixel since the
  /// last end_batch() count together.
  void correct(std::size_t i, float excess) {
    Pixel& pixel = pixels_[i];
    const float fraction = std::max(correction_, 1 / (pixel.corrections + 1));
    const float change = fraction * (excess - pixel.corrected);
    pixel.log_intensity -= change;
    pixel.corrected += change;
    pixel.corrections += 1;
  }
  void end_batch(std::size_t i) { pixels_[i].corrected = 0; }

 private:
  struct Pixel {
    float log_intensity = 0;
    float corrections = 0;
    float corrected = 0;
    float half_threshold = 0;  ///< of the last event; 0 before the first
  };

  int width_;
  float on_, off_;
  float correction_;
  std::vector<Pixel> pixels_;
};

}  // namespace saccade
