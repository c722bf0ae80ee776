#pragma once

#include "core/image.h"
#include "simulator/scene/texture/texture_options.h"

namespace saccade {

/// The same picture for any number of threads, in linear light within `albedo`. Throws InputError
/// when an option is out of range.
[[nodiscard]] ImageF generate_texture(const TextureOptions& options);

}  // namespace saccade
