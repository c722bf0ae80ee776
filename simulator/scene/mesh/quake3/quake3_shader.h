#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// What of a surface covers what is behind it.
enum class Quake3Coverage : std::uint8_t {
  kAll,
  kWhereOpaque,  ///< where the picture's alpha is 0.5 or more
  kNone          ///< it adds or multiplies light, or is not drawn
};

/// A material as the game's scripts define it, as far as it is shown.
struct Quake3Shader {
  std::string picture;  ///< of the first stage that shows one; "": none is named
  Quake3Coverage coverage = Quake3Coverage::kAll;
  bool is_clamped = false;  ///< the picture does not repeat
  Eigen::Vector2d uv_scale{1, 1};
  std::vector<std::string> ignored;  ///< what else it states, in words
};

/// The shaders of a script (scripts/*.shader), by their names in lower case; the first of a name
/// counts. Scripts of games are full of slips, which the game forgives: so what is not understood
/// is passed over, and nothing is an error.
[[nodiscard]] std::map<std::string, Quake3Shader> parse_quake3_script(std::string_view text);

}  // namespace saccade
