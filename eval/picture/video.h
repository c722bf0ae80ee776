#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "core/image.h"
#include "eval/picture/render.h"
#include "eval/picture/view/sensor_view.h"

namespace saccade {

/// Writes `count` > 0 frames of one size as a video (VideoWriter), with progress; `fps` > 0.
void write_video(const std::filesystem::path& output, std::size_t count, double fps, int crf,
                const std::function<ImageRgb8(std::size_t)>& frame);

/// A film of a stretch of time, `options.slow_motion` times as long, by default of 30 frames per
/// second; `frame` draws a moment [s].
void write_slow_motion_video(const std::filesystem::path& output, const TimeSpan& span,
                     const RenderOptions& options, const std::function<ImageRgb8(double)>& frame);

}  // namespace saccade
