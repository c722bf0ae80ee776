#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/error.h"

namespace saccade::config {

/// Where values come from: a file, or one `--set` of the command line.
struct Source {
  std::string name;  ///< as errors show it: "walls.yaml", "--set events.contrast_on"
  std::filesystem::path
      folder;  ///< what relative paths in it are relative to; empty: the working directory
};

/// One position in a source.
struct SourceLocation {
  std::shared_ptr<const Source> source;
  int line = 0;  ///< 1-based; 0 where a line means nothing

  /// "walls.yaml:12", "--set events.contrast_on", or "" without a source.
  [[nodiscard]] std::string text() const {
    if (!source) return {};
    return line > 0 ? source->name + ":" + std::to_string(line) : source->name;
  }
};

/// "walls.yaml:12: events.log_eps = 2 is above 1" with the separator " = "; where the location is a
/// `--set` of this very key, it names the key already: "--set events.log_eps: 2 is above 1".
[[nodiscard]] inline InputError error_at(const SourceLocation& location, const std::string& name,
                                         const std::string& separator, const std::string& problem) {
  const bool named = location.source && location.source->name == "--set " + name;
  return {location.text(), named ? problem : name + separator + problem};
}

}  // namespace saccade::config
