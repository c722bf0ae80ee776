#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"

namespace saccade {

/// The image of warped events: drawn bilinearly, smoothed by a Gaussian. Around the sensor's pixels
/// it has a margin for events that are warped out of it.
class WarpedImage {
 public:
  WarpedImage(const PinholeCamera& camera, double blur_px);

  /// Of the image's pixels from the sensor's [px].
  [[nodiscard]] int margin() const { return margin_; }
  /// Whether an event there, in the image's pixels, can be drawn.
  [[nodiscard]] bool reaches(float x, float y) const {
    return (x >= least_) & (y >= least_) & (x < right_) & (y < bottom_);
  }
  /// Draws events at (x, y), each within reach or its x < 0, on nothing.
  void draw(std::span<const float> x, std::span<const float> y);
  /// Smooths it, once more at every call.
  void smooth();
  [[nodiscard]] double sum_of_squares() const;
  [[nodiscard]] const ImageF& pixels() const { return image_; }

 private:
  std::vector<float> kernel_;  ///< one half of it, the middle first
  int margin_;
  ImageF image_, row_sums_;
  float least_, right_, bottom_;
};

/// A window's events for an image of them: rays and times.
struct WindowRays {
  std::vector<float> x, y;  ///< of the ray (x, y, 1), undistorted
  std::vector<float> t;     ///< since the middle of the window [s]
  double middle_s = 0;
};

/// Chooses the events of a window that an image of them is made of. An edge that passes a pixel
/// fires several times before it has left it. These events lie on each other when nothing is
/// warped, and would pull any motion towards none, so that only the first of such a burst is taken.
class BurstFilter {
 public:
  /// `camera` with its lens. An event belongs to the burst of the one before at its pixel, of its
  /// polarity, within `burst_share` >= 0 of the window's length. `max_events` > 0 of those that are
  /// left are used, evenly spread.
  BurstFilter(const PinholeCamera& camera, double burst_share, std::size_t max_events);

  /// `events` in order of time, at least one.
  [[nodiscard]] WindowRays rays_of(std::span<const Event> events);

 private:
  void choose(std::span<const Event> events);

  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
  double burst_share_;
  std::size_t max_events_;
  std::vector<TimeNs> last_ns_;      ///< of the last event, by pixel and polarity
  std::vector<std::size_t> chosen_;  ///< the first events of bursts
};

}  // namespace saccade
