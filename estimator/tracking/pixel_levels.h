#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/event.h"

namespace saccade {

/// The log intensity at which each pixel of an event camera fired last: its first value plus the
/// thresholds of its events. At the instant of an event it is exact for an ideal pixel; that of a
/// real one drifts (thresholds that differ, leak, noise), so it is drawn towards what the map shows
/// there: the first times fully, then ever less, down to a constant share.
class PixelLevels {
 public:
  /// Steps of an ON and an OFF event [log units], and the least share of a correction, 0..1.
  PixelLevels(int width, int height, double contrast_on, double contrast_off, double correction)
      : width_(width),
        on_(static_cast<float>(contrast_on)),
        off_(static_cast<float>(contrast_off)),
        correction_(static_cast<float>(correction)),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  [[nodiscard]] std::size_t index(const Event& event) const {
    return static_cast<std::size_t>(event.y) * static_cast<std::size_t>(width_) + event.x;
  }

  /// Nothing is known of any pixel.
  void forget() { std::fill(pixels_.begin(), pixels_.end(), Pixel{}); }
  /// What a pixel fired at is known as well as after `looks` corrections.
  void set(std::size_t i, float level, float looks) { pixels_[i] = {level, looks, 0, 0}; }

  void prefetch(std::size_t i) const { __builtin_prefetch(&pixels_[i]); }
  /// Takes an event in; returns the level that its pixel has reached.
  float step(std::size_t i, int polarity) {
    Pixel& pixel = pixels_[i];
    pixel.half_step = 0.5F * (polarity > 0 ? on_ : -off_);
    pixel.level += 2 * pixel.half_step;
    return pixel.level;
  }

  /// At the pixel's last event.
  [[nodiscard]] float level(std::size_t i) const { return pixels_[i].level; }
  /// What a pixel sees between its events: within a threshold of its level and most likely half of
  /// one further in the direction of its last event, as it went on until the next.
  [[nodiscard]] float between(std::size_t i) const {
    return pixels_[i].level + pixels_[i].half_step;
  }

  /// 0 for an unknown level, towards 1 for one that has been corrected often.
  [[nodiscard]] float trust(std::size_t i) const {
    return pixels_[i].looks / (pixels_[i].looks + 1);
  }

  /// The level of step() was `excess` above what the map shows. Corrections of the same pixel since
  /// the last settle() count together.
  void correct(std::size_t i, float excess) {
    Pixel& pixel = pixels_[i];
    const float share = std::max(correction_, 1 / (pixel.looks + 1));
    const float change = share * (excess - pixel.corrected);
    pixel.level -= change;
    pixel.corrected += change;
    pixel.looks += 1;
  }
  void settle(std::size_t i) { pixels_[i].corrected = 0; }

 private:
  struct Pixel {
    float level = 0;
    float looks = 0;
    float corrected = 0;
    float half_step = 0;  ///< of the last event; 0 before the first
  };

  int width_;
  float on_, off_;
  float correction_;
  std::vector<Pixel> pixels_;
};

}  // namespace saccade
