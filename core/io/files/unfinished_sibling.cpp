#include "core/io/files/unfinished_sibling.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <functional>
#include <mutex>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Tells apart machines, their starts, and the containers on one, whose numbers of processes are
/// their own; empty where that is not known.
std::string machine_tag() {
  static const std::string kTag = [] {
    std::string boot;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
    std::error_code error;
    const fs::path processes = fs::read_symlink("/proc/self/ns/pid", error);
    if (boot.empty() || error) return std::string();
    return fmt::format("{:016x}", std::hash<std::string>{}(boot + processes.string()));
  }();
  return kTag;
}

bool has_ended(pid_t process) { return ::kill(process, 0) != 0 && errno == ESRCH; }

/// Whether a name is one of unfinished_sibling() by a process of this machine that has ended.
bool is_abandoned(std::string_view name) {
  const std::size_t last = name.rfind('-');
  if (!name.starts_with('.') || machine_tag().empty() || last == std::string_view::npos)
    return false;
  const std::string mark = "-" + machine_tag() + ".";
  const std::size_t at = name.rfind(mark, last);
  if (at == std::string_view::npos || at + mark.size() >= last) return false;
  const std::string_view digits = name.substr(at + mark.size(), last - at - mark.size());
  pid_t process = 0;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), process);
  return error == std::errc() && end == digits.end() && process > 0 && has_ended(process);
}

/// Whether a folder has not been asked for before.
bool is_new(const fs::path& folder) {
  static std::mutex guard;
  static auto* const known = new std::set<fs::path>;  // never destroyed: threads may still write
  const std::scoped_lock lock(guard);
  return known->insert(folder).second;
}

}  // namespace

fs::path unfinished_sibling(const fs::path& target, const std::string& kind) {
  static std::atomic<unsigned> counter{0};
  return target.parent_path() / fmt::format(".{}.{}-{}.{}-{}", target.filename().string(), kind,
                                            machine_tag(), ::getpid(), counter++);
}

void remove_abandoned_siblings(const fs::path& folder) {
  if (!is_new(folder)) return;
  std::error_code ignored;
  std::vector<fs::path> abandoned;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (is_abandoned(entry.path().filename().string())) abandoned.push_back(entry.path());
  for (const fs::path& path : abandoned) fs::remove_all(path, ignored);
}

}  // namespace saccade
