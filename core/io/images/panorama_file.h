#pragma once

#include <filesystem>

#include "core/panorama.h"

namespace saccade {

/// Which directions the pixels of a picture beside it show (mosaic.yaml): keys around, left, top,
/// width, height. InputError with `file:line` where one is missing or the rectangle is none.
[[nodiscard]] Panorama read_panorama(const std::filesystem::path& file);
void write_panorama(const std::filesystem::path& file, const Panorama& panorama);

}  // namespace saccade
