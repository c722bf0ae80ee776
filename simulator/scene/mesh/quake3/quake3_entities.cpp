#include "simulator/scene/mesh/quake3/quake3_entities.h"

#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace saccade {
namespace {

/// The text up to the next quotation mark, which it moves behind.
std::string quoted(std::string_view text, std::size_t& at) {
  const std::size_t end = text.find('"', at);
  if (end == std::string_view::npos)
    throw std::runtime_error("a quotation mark of its entities is not closed");
  std::string value(text.substr(at, end - at));
  at = end + 1;
  return value;
}

/// What stands between two braces, behind the first of them.
Quake3Entity entity_at(std::string_view text, std::size_t& at) {
  Quake3Entity entity;
  std::string key;
  bool has_key = false;
  for (;;) {
    at = text.find_first_of("\"}", at);
    if (at == std::string_view::npos)
      throw std::runtime_error("a brace of its entities is not closed");
    if (text[at++] == '}') return entity;
    std::string word = quoted(text, at);
    if (has_key)
      entity.values[key] = std::move(word);
    else
      key = std::move(word);
    has_key = !has_key;
  }
}

}  // namespace

std::string Quake3Entity::value(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() ? "" : found->second;
}

Eigen::Vector3d Quake3Entity::vector(const std::string& key) const {
  std::istringstream text(value(key));
  Eigen::Vector3d v;
  if (!(text >> v.x() >> v.y() >> v.z()) || !v.allFinite()) return Eigen::Vector3d::Zero();
  return v;
}

std::vector<Quake3Entity> parse_quake3_entities(std::string_view text) {
  std::vector<Quake3Entity> entities;
  for (std::size_t at = text.find('{'); at != std::string_view::npos; at = text.find('{', at)) {
    ++at;
    entities.push_back(entity_at(text, at));
  }
  return entities;
}

}  // namespace saccade
