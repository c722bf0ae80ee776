#include "core/process/memory_limit.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "core/error.h"

namespace saccade {
namespace {

/// Of a file that holds a number alone; where it is not there, or holds the word "max", there is no limit.
std::uint64_t limit_in(const char* file) {
  std::uint64_t bytes = 0;
  std::ifstream stream(file);
  return stream >> bytes ? bytes : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

std::uint64_t memory_limit_bytes() {
  std::uint64_t bytes = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES))) *
                        static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
  for (const char* file :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    bytes = std::min(bytes, limit_in(file));
  rlimit address_space{};
  if (getrlimit(RLIMIT_AS, &address_space) == 0)
    bytes = std::min<std::uint64_t>(bytes, address_space.rlim_cur);
  return bytes;
}

void check_memory(double bytes, const std::string& location, const std::string& what,
                  const std::string& cure) {
  const auto limit = static_cast<double>(memory_limit_bytes());
  if (!(bytes > limit)) return;
  throw InputError(location,
                   fmt::format("{} takes about {:.3g} GB of memory, of which there are {:.3g}: {}",
                               what, 1e-9 * bytes, 1e-9 * limit, cure));
}

}  // namespace saccade
