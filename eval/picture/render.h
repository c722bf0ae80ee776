#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "eval/picture/overlay/overlay.h"

namespace saccade {

struct RenderOptions {
  /// Time of a single picture instead of the contact sheet [s]; a video ignores it.
  std::optional<double> time_s = std::nullopt;
  /// The time span of a contact sheet or video [s].
  std::optional<double> start_s = std::nullopt;
  std::optional<double> duration_s = std::nullopt;
  /// Dataset of a run, instead of the one in its run.yaml.
  std::optional<std::filesystem::path> dataset = std::nullopt;
  /// Events drawn per picture, those nearest in time; nullopt: 15 % of the number of pixels, for
  /// stabilized events 100 %.
  std::optional<std::size_t> events = std::nullopt;
  int upscale = 3;  ///< screen pixels per sensor pixel, 1..8
  /// Frame rate of a video, 1..240; nullopt: 30, for views and growing reconstructions 3.
  std::optional<double> fps = std::nullopt;
  int crf = 18;             ///< constant rate factor of H.264, 0..51; larger is smaller and worse
  double slow_motion = 10;  ///< seconds of video per second of recording, > 0
  bool dark = true;         ///< on a dark or a light background
  /// A picture at a fixed pose in the world, over undistorted events and frames; each frame uses
  /// the pose at its own time.
  std::optional<OverlayOptions> overlay = std::nullopt;
  /// One of run_figures() in place of all else; only of a run, as .png.
  std::optional<std::string> figure = std::nullopt;
};

/// Draws a dataset or a run (a folder with run.yaml) into `output`:
///   .png   contact sheet over the whole time, or one picture at `time_s`: grey frame, events and
///          depth of a dataset; events, map tracked over events and trajectory of a run
///   .mp4   events beside the frame, or events under the tracked map; encoded by the program ffmpeg
/// Of an odometry run, four pictures: map over events, depth and image of the current keyframe,
/// trajectory from above with the errors so far:
///   .png   a row per time, or one row at `time_s`
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
/// With `figure` that figure of a run. With an overlay: events and frame, with the picture in them.
/// Throws InputError for another ending, an option out of range, a time without events or truth,
/// and a missing ffmpeg.
void render(const std::filesystem::path& path, const std::filesystem::path& output,
            const RenderOptions& options = {});

}  // namespace saccade
