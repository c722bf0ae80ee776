#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace saccade::detail {

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken contract: %s\n", file, line, condition);
  std::abort();
}

}  // namespace saccade::detail
