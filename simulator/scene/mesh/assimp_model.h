#pragma once

#include <filesystem>
#include <string>

#include "simulator/scene/mesh/assimp_files.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/model.h"

namespace saccade {

/// Whether assimp reads files of this extension (".obj").
[[nodiscard]] bool is_assimp_format(const std::string& extension);

/// A model as assimp finds it, in this process: import_model() runs it in another one, for an
/// importer may crash, hang or take all memory. Indices are as the file has them. Throws
/// std::runtime_error with what is wrong with the file.
[[nodiscard]] Model read_through_assimp(const FileSource& source, const std::filesystem::path& file,
                                        const ReplacedFiles& replaced);

}  // namespace saccade
