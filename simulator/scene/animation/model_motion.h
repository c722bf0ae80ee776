#pragma once

#include <filesystem>
#include <string>

#include "simulator/scene/mesh/model.h"

namespace saccade {

/// The nodes, animations and cameras of a model file, on disk or within an archive; of glTF without
/// its surfaces. Throws InputError where the file cannot be read.
[[nodiscard]] Model read_model_motion(const std::filesystem::path& file);

}  // namespace saccade
