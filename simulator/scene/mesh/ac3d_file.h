#pragma once

#include <filesystem>

#include "simulator/scene/mesh/assimp_files.h"
#include "simulator/scene/mesh/file_source.h"

namespace saccade {

/// An AC3D file (AC3D file format, Inivis, version b) as assimp shall see it: one texture per
/// object. Race tracks of TORCS state up to four ("base", "tiled", "skids", "shad"), of which
/// assimp takes the last, and name those that are not there without quotation marks, which it
/// cannot read. Kept is the first that is a picture. Nothing is replaced in files of other formats,
/// and where none of their lines changes.
[[nodiscard]] ReplacedFiles ac3d_for_assimp(const FileSource& source,
                                            const std::filesystem::path& file);

}  // namespace saccade
