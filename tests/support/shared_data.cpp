#include "tests/support/shared_data.h"

#include <cstdlib>

#include "tests/support/source_path.h"

namespace saccade::testing {

std::filesystem::path find_shared_data(const std::string& name) {
  const char* folder = std::getenv("SACCADE_SHARED_DATA");
  const std::filesystem::path root = folder != nullptr
                                         ? std::filesystem::path(folder)
                                         : std::filesystem::path(source_path("../shared/data"));
  const std::filesystem::path path = root / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace saccade::testing
