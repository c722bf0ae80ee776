#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "eval/picture/overlay/overlay.h"

namespace saccade {

struct RenderOptions {
  /// A picture of this moment instead of the contact sheet [s]; a video ignores it.
  std::optional<double> time_s = std::nullopt;
  /// Part of the time that a sheet or a video shows [s].
  std::optional<double> start_s = std::nullopt;
  std::optional<double> duration_s = std::nullopt;
  /// Dataset of a run, instead of the one in its run.yaml.
  std::optional<std::filesystem::path> dataset = std::nullopt;
  /// Events drawn per picture, those nearest in time; nullopt: 15 % of the number of pixels,
  /// of stabilized events 100 %.
  std::optional<std::size_t> events = std::nullopt;
  int upscale = 3;  ///< screen pixels per sensor pixel, 1..8
  /// Frame rate of a video, 1..240; nullopt: 30, of views and growth 3.
  std::optional<double> fps = std::nullopt;
  int crf = 18;  ///< of a video: H.264's constant rate factor, 0..51, more is smaller and worse
  double slow_motion = 10;  ///< seconds of video per second of recording, > 0
  bool dark = true;         ///< on a dark or a light background
  /// A picture that hangs in the world, over events and frames without lens distortion; each frame
  /// with the pose of its own time.
  std::optional<OverlayOptions> overlay = std::nullopt;
};

/// Draws a dataset or a run (a folder with run.yaml) into `output`:
///   .png   contact sheet over the whole time, or the moment `time_s`: grey frame, events and depth
///          of a dataset; events, map tracked over events and trajectory of a run
///   .mp4   events beside the frame, or events under the tracked map; encoded by the program ffmpeg
/// Of an odometry run, in four pictures: map over events, depth and image of the keyframe in force,
/// path from above with the errors so far:
///   .png   a row per moment, or the moment `time_s`
///   .mp4   the same over time
/// Of a run with views (depth, reconstruct):
///   .png   a row per view, at most six or the one nearest to `time_s`: events, depth or image,
///          truth, error
///   .mp4   the image growing with the events where the run kept growth/, else view after view
/// Of a run with a mosaic:
///   .png   mosaic, truth and error
///   .mp4   the mosaic growing with the events, of a run that kept growth/
/// Of a run that stabilized frames and events: both before and after, at three moments or at
/// `time_s`; likewise in a video.
/// Events are drawn undistorted wherever something is drawn over them.
/// With an overlay: events and frame, with the picture in them.
/// Throws InputError for another ending, an option out of range, a moment without events or truth,
/// and a missing ffmpeg.
void render(const std::filesystem::path& path, const std::filesystem::path& output,
            const RenderOptions& options = {});

}  // namespace saccade
