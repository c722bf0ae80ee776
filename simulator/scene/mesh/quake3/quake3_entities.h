#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// A thing of a Quake III map: lights, doors, places where players begin.
struct Quake3Entity {
  std::map<std::string, std::string> values;

  /// "" where it does not state the key.
  [[nodiscard]] std::string value(const std::string& key) const;
  /// Zero where it does not state three numbers.
  [[nodiscard]] Eigen::Vector3d vector(const std::string& key) const;
};

/// Entities as the text of a map lists them: {"key" "value" ...} one after the other. Throws
/// std::runtime_error where a brace or a quotation mark is not closed.
[[nodiscard]] std::vector<Quake3Entity> parse_quake3_entities(std::string_view text);

}  // namespace saccade
