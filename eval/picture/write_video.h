#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "core/image.h"
#include "core/io/run/run_record.h"
#include "core/process/progress.h"
#include "eval/picture/render.h"
#include "eval/picture/video_writer.h"
#include "eval/picture/view/sensor_view.h"

namespace saccade {

/// Writes `count` > 0 frames of one size as a video (VideoWriter), with progress; `fps` > 0.
inline void write_video(const std::filesystem::path& output, std::size_t count, double fps, int crf,
                        const std::function<ImageRgb8(std::size_t)>& frame) {
  const ImageRgb8 first = frame(0);
  VideoWriter video(output, first.width(), first.height(), fps, crf);
  Progress progress("rendering", count, "frames");
  for (std::size_t i = 0; i < count; ++i) {
    video.add(i == 0 ? first : frame(i));
    progress.add(1);
  }
  video.finish();
}

/// Writes a video of a time span in slow motion, `options.slow_motion` times as long, by default
/// with 30 frames per second; `frame` draws the picture at a time [s].
inline void write_slow_motion_video(const std::filesystem::path& output,
                                    const RunRecord::Window& span, const RenderOptions& options,
                                    const std::function<ImageRgb8(double)>& frame) {
  constexpr double kFps = 30;
  const double fps = options.fps.value_or(kFps);
  const double step_s = 1 / (fps * options.slow_motion);
  const auto count = static_cast<std::size_t>((span.end_s - span.start_s) / step_s) + 1;
  write_video(output, count, fps, options.crf,
              [&](std::size_t i) { return frame(span.start_s + static_cast<double>(i) * step_s); });
}

}  // namespace saccade
