#include "core/refused_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace saccade {

std::optional<InputError> refused_path(const std::filesystem::filesystem_error& error) {
  constexpr std::array kRefusals{std::errc::filename_too_long,
                                 std::errc::too_many_symbolic_link_levels,
                                 std::errc::permission_denied, std::errc::not_a_directory};
  const bool is_refused = std::any_of(kRefusals.begin(), kRefusals.end(),
                                      [&](std::errc reason) { return error.code() == reason; });
  if (!is_refused) return std::nullopt;
  const std::string second =
      error.path2().empty() ? "" : fmt::format(" (to {})", error.path2().string());
  return InputError(error.path1().string() + second,
                    fmt::format("cannot be used: {}", error.code().message()));
}

}  // namespace saccade
