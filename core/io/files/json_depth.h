#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace saccade {

/// Levels of JSON that are read: what copies or prints a tree calls itself for every level.
constexpr std::size_t kMostJsonDepth = 100;

/// The byte of a text of JSON where its lists and objects are nested deeper than that; nullopt: nowhere.
/// Whether it is JSON at all is left to its parser.
[[nodiscard]] std::optional<std::size_t> json_too_deep_at(std::string_view text);

}  // namespace saccade
