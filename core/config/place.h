#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace saccade::config {

/// Where values come from: a file, or one `--set` of the command line.
struct Source {
  std::string name;  ///< as errors show it: "walls.yaml", "--set events.contrast_on"
  std::filesystem::path
      folder;  ///< what relative paths in it are relative to; empty: the working directory
};

/// One position in a source.
struct Place {
  std::shared_ptr<const Source> source;
  int line = 0;  ///< 1-based; 0 where a line means nothing

  /// "walls.yaml:12", "--set events.contrast_on", or "" without a source.
  [[nodiscard]] std::string text() const {
    if (!source) return {};
    return line > 0 ? source->name + ":" + std::to_string(line) : source->name;
  }
};

}  // namespace saccade::config
