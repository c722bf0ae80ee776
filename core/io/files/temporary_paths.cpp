#include "core/io/files/temporary_paths.h"

#include <mutex>
#include <set>
#include <system_error>
#include <utility>

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Never destroyed: threads may still work while the program ends.
struct PathRegistry {
  std::mutex mutex;
  std::multiset<fs::path> paths;
};

PathRegistry& path_registry() {
  static auto* const registry = new PathRegistry;
  return *registry;
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

}  // namespace

TemporaryPath::TemporaryPath(fs::path path) : path_(std::move(path)) {
  const std::scoped_lock lock(path_registry().mutex);
  path_registry().paths.insert(path_);
}

TemporaryPath::~TemporaryPath() {
  remove_quietly(path_);
  const std::scoped_lock lock(path_registry().mutex);
  path_registry().paths.erase(path_registry().paths.find(path_));
}

void remove_temporary_paths() {
  PathRegistry& registry = path_registry();
  registry.mutex.lock();  // for good
  // Twice: a thread may have been about to write another file into a folder.
  for (int round = 0; round < 2; ++round)
    for (const fs::path& path : registry.paths) remove_quietly(path);
}

}  // namespace saccade
