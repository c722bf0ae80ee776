#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/config/node.h"

namespace saccade::config {

/// A configuration as stated: includes merged, overrides applied, nothing checked yet.
class Document {
 public:
  /// No file at all: the defaults and these overrides.
  [[nodiscard]] static Document empty(std::span<const std::string> overrides = {});

  explicit Document(Node root);  ///< `root`: a map
  [[nodiscard]] const Node& root() const { return root_; }

 private:
  Node root_;
};

/// Reads a YAML file. A root key `include` (a file name or a list of them, relative to the stating
/// file) brings in other files first; the including file's keys win, later includes over earlier
/// ones: maps are merged key by key, everything else is replaced, and `key: ~` takes an included
/// key back. `overrides` are "key.path=value" (value in YAML, list items by index:
/// "scene.meshes.0.file=a.obj"; relative paths in them are relative to the working directory),
/// applied in order: the value replaces what was there, whole maps too, and `~` removes the key.
/// Throws InputError with file:line or `--set key.path` for all that is no valid YAML, duplicate
/// keys, missing files, include cycles, chains of more than 32 includes and more than 256 in all.
[[nodiscard]] Document load(const std::filesystem::path& file,
                            std::span<const std::string> overrides = {});

/// The same for YAML text in memory; errors call it `name`, paths and includes are relative to
/// `folder`.
[[nodiscard]] Document parse(std::string_view yaml, const std::string& name,
                             const std::filesystem::path& folder = {},
                             std::span<const std::string> overrides = {});

}  // namespace saccade::config
