#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/io/dataset.h"
#include "core/trajectory.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/image/image_picture.h"

namespace saccade {

/// How pictures of a dataset are drawn.
struct SensorViewStyle {
  int upscale = 3;         ///< screen pixels per sensor pixel
  std::size_t events = 0;  ///< per picture; 0: 15 % of the number of pixels
  Theme theme = kDarkTheme;
};

struct FramePicture {
  double t_s = 0;
  ImageRgb8 image;
};

struct DepthPicture {
  ImageRgb8 image;
  DepthRange range;
};

/// Draws what a dataset's sensor saw at a moment; all pictures have the same size, width x upscale
/// by height x upscale. Holds the events of a stretch of time in memory.
class SensorView {
 public:
  /// Loads the events between the two times, with a margin for the pictures at the ends.
  SensorView(const Dataset& dataset, double start_s, double end_s, const SensorViewStyle& style);

  [[nodiscard]] int width() const { return camera_.width * style_.upscale; }
  [[nodiscard]] int height() const { return camera_.height * style_.upscale; }
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }  ///< undistorted
  [[nodiscard]] const Theme& theme() const { return style_.theme; }

  /// As the sensor gave them.
  [[nodiscard]] ImageRgb8 events(double t_s) const;
  /// The map projected from a pose over the undistorted events.
  [[nodiscard]] ImageRgb8 map_over_events(double t_s,
                                          std::span<const Eigen::Vector3f> points_in_world,
                                          const Rigid3& world_from_camera) const;
  /// The undistorted events alone.
  [[nodiscard]] ImageRgb8 undistorted_events(double t_s) const;
  /// The latest grey frame at `t_s` as a camera without distortion would have seen it, with its own
  /// time; nullopt when the dataset has none.
  [[nodiscard]] std::optional<FramePicture> undistorted_frame(double t_s) const;
  /// The latest grey frame and depth map at `t_s` (the first one before it); nullopt when the
  /// dataset has none.
  [[nodiscard]] std::optional<ImageRgb8> frame(double t_s) const;
  [[nodiscard]] std::optional<ImageRgb8> depth(double t_s) const;  ///< with a colour bar
  /// The same without the bar, one pixel per sensor pixel.
  [[nodiscard]] std::optional<DepthPicture> plain_depth(double t_s) const;

 private:
  [[nodiscard]] std::span<const Event> around(double t_s) const;

  const Dataset& dataset_;
  PinholeCamera camera_;
  SensorViewStyle style_;
  Events events_;
};

/// First and last event time [s], or the span of the ground truth where there are no events.
struct TimeSpan {
  double start_s = 0;
  double end_s = 0;
};
[[nodiscard]] TimeSpan time_span(const Dataset& dataset);

}  // namespace saccade
