#include "core/config/former_keys.h"

#include <vector>

namespace saccade::config {
namespace {

/// "scene.meshes[0].file" -> "scene.meshes.file".
std::string without_indices(std::string_view path) {
  std::string keys;
  bool in_index = false;
  for (const char c : path) {
    if (c == '[') in_index = true;
    if (!in_index) keys += c;
    if (c == ']') in_index = false;
  }
  return keys;
}

bool is_end_of(std::string_view old_key, std::string_view path) {
  if (!path.ends_with(old_key)) return false;
  return path.size() == old_key.size() || path[path.size() - old_key.size() - 1] == '.';
}

}  // namespace

// Dropped at version 1.0.
std::span<const FormerKey> former_keys() {
  static const std::vector<FormerKey> kRows{
      // clang-format off
      // rows begin
      // rows end
      // clang-format on
  };
  return kRows;
}

std::optional<std::string> explain_former_key(std::string_view path,
                                              std::span<const FormerKey> rows) {
  const std::string keys = without_indices(path);
  const FormerKey* longest = nullptr;
  for (const FormerKey& row : rows) {
    const bool is_longer = longest == nullptr || row.old_key.size() > longest->old_key.size();
    if (is_longer && is_end_of(row.old_key, keys)) longest = &row;
  }
  if (longest == nullptr) return std::nullopt;
  const std::string old_key = "'" + std::string(longest->old_key) + "'";
  if (!longest->new_key.empty()) return old_key + " is now '" + std::string(longest->new_key) + "'";
  const bool is_value = longest->old_key.find('=') != std::string_view::npos;
  return old_key + " is no longer a " + (is_value ? "value" : "key") + ": " +
         std::string(longest->note);
}

}  // namespace saccade::config
