#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/run/run_record.h"
#include "core/trajectory.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/image/image_picture.h"

namespace saccade {

/// The style of pictures of a dataset.
struct SensorViewStyle {
  int upscale = 3;         ///< screen pixels per sensor pixel
  std::size_t events = 0;  ///< per picture; 0: 15 % of the number of pixels
  Theme theme = kDarkTheme;
};

struct DepthPicture {
  ImageRgb8 image;
  DepthRange range;
};

/// Draws the data of a dataset at a time; all pictures have the same size, width x upscale by
/// height x upscale. Holds the events of a time span in memory.
class SensorView {
 public:
  /// Loads the events between the two times, with a margin for the pictures at the ends.
  SensorView(const Dataset& dataset, double start_s, double end_s, const SensorViewStyle& style);

  [[nodiscard]] int width() const { return camera_.width * style_.upscale; }
  [[nodiscard]] int height() const { return camera_.height * style_.upscale; }
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }  ///< undistorted
  [[nodiscard]] const Theme& theme() const { return style_.theme; }

  /// Distorted, as recorded.
  [[nodiscard]] ImageRgb8 events(double t_s) const;
  /// The map projected from a pose over the undistorted events.
  [[nodiscard]] ImageRgb8 map_over_events(double t_s,
                                          std::span<const Eigen::Vector3f> points_in_world,
                                          const Rigid3& world_from_camera) const;
  /// The undistorted events alone.
  [[nodiscard]] ImageRgb8 undistorted_events(double t_s) const;
  /// Time [s] and picture of the latest grey frame at `t_s`, undistorted; nullopt when the dataset
  /// has no frames.
  [[nodiscard]] std::optional<std::pair<double, ImageRgb8>> undistorted_frame(double t_s) const;
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

/// Index of the last file at or before `t_s`, or 0; `files` is not empty.
[[nodiscard]] std::size_t current_file(const std::vector<StampedFile>& files, double t_s);

/// Index of the file nearest in time; nullopt where `files` is empty.
[[nodiscard]] std::optional<std::size_t> nearest_file(const std::vector<StampedFile>& files,
                                                      double t_s);

/// First and last event time [s], or the span of the ground truth where there are no events.
[[nodiscard]] RunRecord::Window time_span(const Dataset& dataset);

}  // namespace saccade
