#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace saccade::config {

/// Damerau-Levenshtein distance (optimal string alignment: insert, delete, replace, swap
/// neighbours; each part of the text is edited once), ASCII letters without regard to case.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that somebody who wrote `word` most likely meant: the nearest one, the first among
/// equals. None when all differ in more than a third of the letters; a name without its unit
/// ("rate" for "rate_hz") is near.
[[nodiscard]] std::optional<std::string> nearest(std::string_view word,
                                                 std::span<const std::string> candidates);

/// "a, b, c".
[[nodiscard]] std::string joined(std::span<const std::string> names);

/// The end of an error about an unknown name: "did you mean 'samples'?", or, when none is near,
/// "valid keys: a, b, c" with `what` = "keys".
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string> candidates,
                                     std::string_view what);

}  // namespace saccade::config
