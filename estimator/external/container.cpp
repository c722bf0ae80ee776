#include "estimator/external/container.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string_view>

#include "core/error.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

bool is_on_search_path(const char* program) {
  const char* path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(folder.size() + 1, rest.size()));
    if (!folder.empty() && ::access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

/// Apptainer takes these characters for its own.
std::string bindable(const fs::path& folder) {
  if (folder.string().find_first_of(":,") != std::string::npos)
    throw InputError(folder.string(), "cannot be shown to a container: its name holds ':' or ','");
  return folder.string();
}

std::string runtime() {
  for (const char* program : {"apptainer", "singularity"})
    if (is_on_search_path(program)) return program;
  throw InputError("container",
                   "needs apptainer or singularity on the search path, of which neither is there");
}

}  // namespace

std::vector<std::string> words_in_container(const std::vector<std::string>& words,
                                            const fs::path& image, const fs::path& writable,
                                            std::span<const fs::path> readable) {
  std::vector<std::string> all{runtime(), "exec"};
  std::set<std::string> bound;
  for (const fs::path& folder : readable)
    if (bound.insert(bindable(folder)).second)
      all.insert(all.end(), {"--bind", folder.string() + ":" + folder.string() + ":ro"});
  // Last, so that no folder above it that may only be read hides it.
  all.insert(all.end(), {"--bind", bindable(writable), "--pwd", (writable / "output").string(),
                         image.string()});
  all.insert(all.end(), words.begin(), words.end());
  return all;
}

}  // namespace saccade
