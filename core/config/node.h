#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/config/source_location.h"

namespace saccade::config {

struct Entry;

/// One value of a configuration tree, with its location. Maps keep the order of the file and hold
/// every key once.
struct Node {
  enum class Kind { kNull, kScalar, kList, kMap };

  Kind kind = Kind::kNull;
  SourceLocation location;
  std::string text;            ///< of a scalar, unquoted
  bool quoted = false;         ///< a quoted scalar is text, never a number or a truth value
  std::vector<Node> items;     ///< of a list
  std::vector<Entry> entries;  ///< of a map

  [[nodiscard]] static Node scalar(std::string text, bool quoted);
  [[nodiscard]] static Node list();
  [[nodiscard]] static Node map();

  /// The entry of a map with this key; nullptr when there is none or this is no map.
  [[nodiscard]] const Entry* find(std::string_view key) const;
  [[nodiscard]] Entry* find(std::string_view key);

  /// What an error calls it: "'abc'", "a list", "a map", "nothing".
  [[nodiscard]] std::string shown() const;
};

struct Entry {
  std::string key;
  SourceLocation location;  ///< of the key
  Node value;
  std::string comment;  ///< written behind the key by a documented print
  std::string rules{};  ///< "> 0, <= 1", in brackets behind the comment
};

}  // namespace saccade::config
