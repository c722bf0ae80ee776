#include "core/config/source_location.h"

namespace saccade::config {

std::string SourceLocation::text() const {
  if (!source) return {};
  return line > 0 ? source->name + ":" + std::to_string(line) : source->name;
}

InputError error_at(const SourceLocation& location, const std::string& name,
                    const std::string& separator, const std::string& problem) {
  const bool named = location.source && location.source->name == "--set " + name;
  return {location.text(), named ? problem : name + separator + problem};
}

}  // namespace saccade::config
