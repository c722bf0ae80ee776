#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulator/scene/mesh/file_source.h"

namespace saccade {

/// The files of a game as its maps see them: those of the map's own archive or folder, then those
/// of the other archives (*.pk3) beside it, the last by name first, as the game takes them. Not
/// thread-safe.
class Quake3Files {
 public:
  struct Found {
    const FileSource* source;
    std::filesystem::path file;
  };

  /// `own`: where the map is; outlives it. `map`: its path there.
  Quake3Files(const FileSource& own, const std::filesystem::path& map);

  /// The picture that a shader names, whatever its ending: "textures/wall/brick".
  [[nodiscard]] std::optional<Found> picture(const std::string& name) const;
  /// All scripts of shaders; the first that defines a shader is right.
  [[nodiscard]] std::vector<Found> scripts() const;
  /// Where it looks, for errors.
  [[nodiscard]] std::string places() const;
  /// What is wrong with archives beside the map that cannot be opened.
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  [[nodiscard]] std::vector<const FileSource*> sources() const;
  [[nodiscard]] std::filesystem::path path_in(const FileSource& source,
                                              const std::filesystem::path& file) const;

  const FileSource& own_;
  std::filesystem::path root_;  ///< of the game, in own_
  std::vector<FileSource> archives_;
  std::vector<std::string> problems_;
};

}  // namespace saccade
