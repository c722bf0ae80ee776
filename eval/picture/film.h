#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "core/image.h"

namespace saccade {

/// Writes `count` > 0 frames of one size as a video (VideoWriter), with progress; `fps` > 0.
void write_film(const std::filesystem::path& output, std::size_t count, double fps,
                const std::function<ImageRgb8(std::size_t)>& frame);

}  // namespace saccade
