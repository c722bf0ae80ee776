#include "core/io/files/temporary_paths.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "core/process/other_threads.h"

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

/// Calls rm, for who may not use the heap; without a word where it cannot.
void remove_by_program(const std::vector<const char*>& words) {
  const pid_t child = ::_Fork();
  if (child == 0) {
    ::setpgid(0, 0);  // out of reach of another Ctrl-C
    ::execv("/bin/rm", const_cast<char* const*>(words.data()));
    ::_exit(1);
  }
  while (child > 0 && ::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
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
  for (const fs::path& path : registry.paths) remove_quietly(path);
  // What a thread was just about to write stands there again; the words are made while the heap may be used, and never
  // given back, since then it may not.
  auto& words = *new std::vector<const char*>{"rm", "-rf", "--"};
  for (const fs::path& path : registry.paths) words.push_back(path.c_str());
  words.push_back(nullptr);
  hold_other_threads();
  const auto stands = [](const fs::path& path) {
    struct stat ignored {};
    return ::lstat(path.c_str(), &ignored) == 0;
  };
  if (std::any_of(registry.paths.begin(), registry.paths.end(), stands)) remove_by_program(words);
}

}  // namespace saccade
