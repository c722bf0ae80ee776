#pragma once

#include <filesystem>
#include <string>

#include "core/process/forked_call.h"
#include "simulator/scene/mesh/assimp_files.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/model.h"

namespace saccade {

/// Reads a model through assimp, or a Quake III map, in a process of its own, so that an importer
/// that crashes, hangs or takes all memory becomes an error. `file` of `source`; `source_name` is
/// what errors name. Throws InputError when the format is unknown, the file is damaged, its
/// material library is missing, or the importer dies.
[[nodiscard]] Model import_model(const FileSource& source, const std::filesystem::path& file,
                                 const std::string& source_name, const ReplacedFiles& replaced = {},
                                 const ForkLimits& limits = {});

/// Its three steps, for imports ahead of their use (model_imports.h): InputError when the format is
/// unknown; the import itself, for the other process; and what became of it.
void check_model_format(const std::filesystem::path& file, const std::string& source_name);
[[nodiscard]] std::string import_in_child(const FileSource& own, const std::filesystem::path& file,
                                          const ReplacedFiles& replaced);
[[nodiscard]] Model model_of(const ForkedResult& result, const std::filesystem::path& file,
                             const std::string& source_name);

}  // namespace saccade
