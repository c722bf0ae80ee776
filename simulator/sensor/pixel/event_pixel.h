#pragma once

#include <algorithm>

namespace saccade {

/// Contrast thresholds of a pixel [log units], both > 0.
struct Contrast {
  double on = 0.15;
  double off = 0.15;
};

/// Values between which a pixel stays without an event.
struct Band {
  double lower = 0;  ///< fires OFF when the signal falls to it
  double upper = 0;  ///< fires ON when the signal rises to it

  [[nodiscard]] bool contains(double value) const { return value < upper && value > lower; }
};

/// An event pixel's memory: the level from which it measures contrast. The level is rebuilt from
/// two counters, so it has no drift: a signal that returns to a former level intersects exactly the
/// former thresholds.
class EventPixel {
 public:
  EventPixel() = default;
  EventPixel(double initial_level, const Contrast& contrast) { reset(initial_level, contrast); }

  [[nodiscard]] const Band& band() const { return band_; }

  /// The level becomes that of the signal.
  void reset(double level, const Contrast& contrast) {
    initial_ = level;
    ons_ = offs_ = 0;
    update(contrast);
  }

  /// The level moves by exactly a threshold.
  void fire(int polarity, const Contrast& contrast) {
    (polarity > 0 ? ons_ : offs_) += 1;
    update(contrast);
  }

 private:
  void update(const Contrast& contrast) {
    band_.upper = level(ons_ + 1, offs_, contrast);
    band_.lower = level(ons_, offs_ + 1, contrast);
  }

  /// Pairs of ON and OFF cancel before anything is rounded.
  [[nodiscard]] double level(double ons, double offs, const Contrast& contrast) const {
    const double pairs = std::min(ons, offs);
    return initial_ + ((ons - pairs) * contrast.on - (offs - pairs) * contrast.off) +
           pairs * (contrast.on - contrast.off);
  }

  double initial_ = 0;
  Band band_;
  double ons_ = 0;  ///< whole numbers
  double offs_ = 0;
};

}  // namespace saccade
