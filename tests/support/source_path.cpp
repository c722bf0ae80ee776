#include "tests/support/source_path.h"

namespace saccade::testing {

std::string source_path(const std::string& relative) {
  return std::string(SACCADE_SOURCE_DIR) + "/" + relative;
}

}  // namespace saccade::testing
