#include "core/config/place.h"

namespace saccade::config {

std::string Place::text() const {
  if (!source) return {};
  return line > 0 ? source->name + ":" + std::to_string(line) : source->name;
}

InputError error_at(const Place& place, const std::string& name, const std::string& separator,
                    const std::string& problem) {
  const bool named = place.source && place.source->name == "--set " + name;
  return {place.text(), named ? problem : name + separator + problem};
}

}  // namespace saccade::config
