#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/event.h"

namespace saccade {

/// What is known of a pixel of an event camera: the log intensity at which it fired last, which is
/// its first value plus the thresholds of its events, and the variance of that. It is exact for an
/// ideal pixel. That of a real one drifts, because its thresholds differ from those of the sensor,
/// so that every event adds to the variance; measurements of the log intensity bring it down (a
/// Kalman filter of a random walk for each pixel).
class PixelLogIntensity {
 public:
  PixelLogIntensity(int width, int height)
      : width_(width),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  [[nodiscard]] std::size_t index(const Event& event) const {
    return static_cast<std::size_t>(event.y) * static_cast<std::size_t>(width_) + event.x;
  }

  /// No pixel is known.
  void reset() { std::fill(pixels_.begin(), pixels_.end(), Pixel{}); }
  void set(std::size_t i, float log_intensity, float variance) {
    pixels_[i] = {log_intensity, variance, 0, kNoSlot, pixels_[i].last_ns};
  }
  /// Thresholds of an ON and an OFF event [log units], > 0, of the events to come.
  void set_thresholds(double on, double off) {
    on_ = static_cast<float>(on);
    off_ = static_cast<float>(off);
  }
  /// That an event adds.
  void set_event_variance(float variance) { event_variance_ = variance; }

  void prefetch(std::size_t i) const { __builtin_prefetch(&pixels_[i]); }
  /// Takes an event in; returns the log intensity that its pixel has reached.
  float add_event(std::size_t i, int polarity, TimeNs t_ns) {
    Pixel& pixel = pixels_[i];
    pixel.last_ns = t_ns;
    pixel.half_threshold = 0.5F * (polarity > 0 ? on_ : -off_);
    pixel.log_intensity += 2 * pixel.half_threshold;
    pixel.variance += event_variance_;
    return pixel.log_intensity;
  }

  /// At the pixel's last event.
  [[nodiscard]] float at_last_event(std::size_t i) const { return pixels_[i].log_intensity; }
  /// Between its events a pixel is within a threshold of its last value, and most likely half of
  /// one further in the direction of its last event.
  [[nodiscard]] float between_events(std::size_t i) const {
    return pixels_[i].log_intensity + pixels_[i].half_threshold;
  }
  /// Whether it has, since its value was set.
  [[nodiscard]] bool has_fired(std::size_t i) const { return pixels_[i].half_threshold != 0; }
  /// Infinite for an unknown pixel.
  [[nodiscard]] float variance(std::size_t i) const { return pixels_[i].variance; }

  /// A measurement of variance `noise` > 0 says that the pixel's value is `excess` too high.
  void correct(std::size_t i, float excess, float noise) {
    Pixel& pixel = pixels_[i];
    const bool is_known = pixel.variance < kUnknown;
    const float gain = is_known ? pixel.variance / (pixel.variance + noise) : 1;
    pixel.log_intensity -= gain * excess;
    pixel.variance = is_known ? (1 - gain) * pixel.variance : noise;
  }

  /// The pixel's value has changed by `change`, and is less certain by `variance`.
  void move(std::size_t i, float change, float variance) {
    pixels_[i].log_intensity += change;
    pixels_[i].variance += variance;
  }
  /// kNoEvent before the first.
  [[nodiscard]] TimeNs last_event_ns(std::size_t i) const { return pixels_[i].last_ns; }
  static constexpr TimeNs kNoEvent = std::numeric_limits<TimeNs>::min();

  /// A number that is kept with each pixel; kNoSlot at first.
  static constexpr std::uint32_t kNoSlot = ~std::uint32_t{0};
  [[nodiscard]] std::uint32_t slot(std::size_t i) const { return pixels_[i].slot; }
  void set_slot(std::size_t i, std::uint32_t slot) { pixels_[i].slot = slot; }

 private:
  static constexpr float kUnknown = std::numeric_limits<float>::infinity();
  struct Pixel {
    float log_intensity = 0;
    float variance = kUnknown;
    float half_threshold = 0;  ///< of the last event; 0 before the first
    std::uint32_t slot = kNoSlot;
    TimeNs last_ns = kNoEvent;
  };

  int width_;
  float on_ = 0, off_ = 0;
  float event_variance_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace saccade
