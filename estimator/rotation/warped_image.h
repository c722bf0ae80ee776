#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"

namespace saccade {

/// Image of warped events (IWE): drawn bilinearly, smoothed by a Gaussian. A margin around the
/// sensor's pixels holds events that are warped out of them.
class WarpedImage {
 public:
  WarpedImage(const PinholeCamera& camera, double blur_px);

  /// Offset of the image's pixels from the sensor's [px].
  [[nodiscard]] int margin() const { return margin_; }
  /// Whether an event at (x, y), in the image's pixels, can be drawn.
  [[nodiscard]] bool contains(float x, float y) const {
    return (x >= min_) & (y >= min_) & (x < max_x_) & (y < max_y_);
  }
  /// Clears the image and draws events at (x, y); those with x < 0 are left out, the others lie within
  /// the image (contract).
  void draw(std::span<const float> x, std::span<const float> y);
  /// Smooths the image, once more at every call.
  void smooth();
  [[nodiscard]] double sum_of_squares() const;
  [[nodiscard]] const ImageF& pixels() const { return image_; }

 private:
  std::vector<float> kernel_;  ///< right half, the middle first
  int margin_;
  ImageF image_, row_sums_;
  float min_, max_x_, max_y_;
};

/// Bearings and times of selected events of a window.
struct WindowRays {
  std::vector<float> x, y;  ///< of the bearing (x, y, 1), undistorted
  std::vector<float> t;     ///< since the middle of the window [s]
  double middle_s = 0;
};

/// What a burst of events is, in fractions of the window's length, >= 0.
struct BurstLimits {
  double gap;  ///< an event belongs to the burst of its pixel's and polarity's last event if ...
  double longest;  ///< ... it follows it within `gap`, and the burst's first event within this
};

/// Selects the events of a window for an image of warped events. An edge that passes a pixel fires
/// a burst of events there. Without any warp these lie on one another, which biases every motion
/// towards zero: only the first event of a burst is used.
class BurstFilter {
 public:
  /// `camera` with its lens. Of the remaining events at most about `max_events` > 0 are used, evenly
  /// spread.
  BurstFilter(const PinholeCamera& camera, const BurstLimits& limits, std::size_t max_events);

  /// `events` in order of time, at least one.
  [[nodiscard]] WindowRays rays_of(std::span<const Event> events);

 private:
  void select(std::span<const Event> events);

  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
  BurstLimits limits_;
  std::size_t max_events_;
  struct Burst {
    TimeNs first_ns, last_ns;
  };
  std::vector<Burst> bursts_;          ///< the last one, by pixel and polarity
  std::vector<std::size_t> selected_;  ///< the first events of bursts
};

}  // namespace saccade
