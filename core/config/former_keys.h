#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace saccade::config {

/// A key of an earlier version, so that an old configuration is answered with what to write
/// instead. Kept until version 1.0, which drops the table.
struct FormerKey {
  /// Dotted, without list indices: a whole path ("intensity.levels.still_px") or the end of one
  /// ("levels.still_px"); a single word is a key of the root. "key=value" is a former value of a
  /// choice.
  std::string_view old_key;
  std::string_view new_key;  ///< "" where the key was removed
  /// Of a removed key: what completes "is no longer a key: ...", e.g. "it is always 0.3 px".
  std::string_view note;
};

/// All rows, sorted by old_key.
[[nodiscard]] std::span<const FormerKey> former_keys();

/// What an error says about the key at `path` ("scene.meshes[0].file"): "'levels.still_px' is now
/// 'no_event.spacing_px'" or "'levels.still_px' is no longer a key: it is always 0.3 px". The row
/// with the longest old_key that is the path or an end of it decides; nullopt when there is none.
[[nodiscard]] std::optional<std::string> explain_former_key(std::string_view path,
                                                            std::span<const FormerKey> rows);

}  // namespace saccade::config
