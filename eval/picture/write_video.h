#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "core/image.h"
#include "core/io/run/run_record.h"
#include "eval/picture/render.h"
#include "eval/picture/view/sensor_view.h"

namespace saccade {

/// Writes `count` > 0 frames of one size as a video (VideoWriter), with progress; `fps` > 0.
void write_video(const std::filesystem::path& output, std::size_t count, double fps, int crf,
                 const std::function<ImageRgb8(std::size_t)>& frame);

/// Writes a video of a time span in slow motion, `options.slow_motion` times as long, by default
/// with 30 frames per second; `frame` draws the picture at a time [s].
void write_slow_motion_video(const std::filesystem::path& output, const RunRecord::Window& span,
                             const RenderOptions& options,
                             const std::function<ImageRgb8(double)>& frame);

}  // namespace saccade
