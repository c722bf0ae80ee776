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
  std::vector<std::string> all{runtime(), "exec", "--bind", writable.string()};
  std::set<std::string> bound;
  for (const fs::path& folder : readable)
    if (bound.insert(folder.string()).second)
      all.insert(all.end(), {"--bind", folder.string() + ":" + folder.string() + ":ro"});
  all.insert(all.end(), {"--pwd", (writable / "output").string(), image.string()});
  all.insert(all.end(), words.begin(), words.end());
  return all;
}

}  // namespace saccade
