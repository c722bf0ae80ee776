#include "core/io/import/folder_search.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Empty where there is none.
fs::path only_one(const std::vector<fs::path>& found, const fs::path& folder) {
  if (found.size() > 1)
    throw InputError(folder.string(),
                     fmt::format("holds both {} and {}; keep the one that belongs to the sequence, "
                                 "or name it",
                                 found[0].filename().string(), found[1].filename().string()));
  return found.empty() ? fs::path() : found[0];
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> list;
  if (!fs::is_directory(folder)) return list;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_directory()) list.push_back(entry.path());
  std::sort(list.begin(), list.end());
  return list;
}

}  // namespace

std::vector<fs::path> files_in(const fs::path& folder, const std::string& begin,
                               const std::string& end) {
  std::vector<fs::path> list;
  if (!fs::is_directory(folder)) return list;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(end) && entry.is_regular_file())
      list.push_back(entry.path());
  }
  std::sort(list.begin(), list.end());
  return list;
}

fs::path find_near(const fs::path& folder, const std::string& begin, const std::string& end) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  const fs::path above = (whole.has_filename() ? whole : whole.parent_path()).parent_path();
  for (const fs::path& place : {whole, above}) {
    if (fs::path found = only_one(files_in(place, begin, end), place); !found.empty()) return found;
    std::vector<fs::path> below;
    for (const fs::path& next : folders_in(place))
      for (const fs::path& file : files_in(next, begin, end)) below.push_back(file);
    if (fs::path found = only_one(below, place); !found.empty()) return found;
  }
  return {};
}

fs::path file_or_in_folder(const fs::path& path, const std::string& end) {
  if (fs::is_regular_file(path)) return path.filename().string().ends_with(end) ? path : fs::path();
  return only_one(files_in(path, "", end), path);
}

}  // namespace saccade
