#include "core/refused_path.h"

#include <fmt/format.h>

namespace saccade {

InputError refused_path(const std::filesystem::filesystem_error& error) {
  const std::string second =
      error.path2().empty() ? "" : fmt::format(" (to {})", error.path2().string());
  return {error.path1().string() + second,
          fmt::format("cannot be used: {}", error.code().message())};
}

}  // namespace saccade
