#include "core/config/shipped.h"

#include <dlfcn.h>

#include <algorithm>

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/process/program.h"

namespace saccade::config {
namespace {

namespace fs = std::filesystem;

/// The first folder above `file` that holds what is shipped.
fs::path folder_above(const fs::path& file) {
  std::error_code error;
  for (fs::path above = fs::canonical(file, error).parent_path(); above.has_relative_path();
       above = above.parent_path())
    for (const fs::path& folder : {above / "share" / "saccade", above})
      if (fs::is_directory(folder / "configs" / "simulation", error) &&
          fs::is_directory(folder / "scenes", error))
        return folder;
  return {};
}

/// Of the shared library that holds this code, else of the program. A program's own name, as
/// dladdr() gives it, is what it was called by and need not be a path.
fs::path search_shipped_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&search_shipped_folder), &info) != 0 &&
      info.dli_fname != nullptr && fs::path(info.dli_fname).extension() == ".so")
    if (const fs::path found = folder_above(info.dli_fname); !found.empty()) return found;
  return folder_above(program_file());
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// What a user may write for a shipped configuration, without "configs/" and ".yaml".
std::string short_name(const fs::path& stated) {
  fs::path name = stated.extension() == ".yaml" ? fs::path(stated).replace_extension() : stated;
  if (!name.empty() && *name.begin() == "configs") name = name.lexically_relative("configs");
  return name.generic_string();
}

std::string last_part(const std::string& name) { return name.substr(name.rfind('/') + 1); }

}  // namespace

const fs::path& shipped_folder() {
  static const fs::path kFolder = search_shipped_folder();
  return kFolder;
}

std::vector<std::string> shipped_configurations() {
  std::vector<std::string> names;
  if (shipped_folder().empty()) return names;
  const fs::path configs = shipped_folder() / "configs";
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(configs))
    if (entry.path().extension() == ".yaml")
      names.push_back(
          entry.path().lexically_relative(configs).replace_extension().generic_string());
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<fs::path> find_shipped(const fs::path& name) {
  if (name.empty() || name.is_absolute() || shipped_folder().empty()) return std::nullopt;
  if (is_file(shipped_folder() / name)) return shipped_folder() / name;
  const fs::path configs = shipped_folder() / "configs";
  const std::string wanted = short_name(name);
  if (is_file(configs / (wanted + ".yaml"))) return configs / (wanted + ".yaml");
  std::vector<std::string> alike;
  for (const std::string& one : shipped_configurations())
    if (last_part(one) == wanted) alike.push_back(one);
  if (alike.size() > 1)
    throw InputError(
        name.string(),
        "several shipped configurations have this name, write one of: " + joined(alike));
  return alike.empty() ? std::nullopt : std::optional(configs / (alike.front() + ".yaml"));
}

fs::path find_configuration(const fs::path& stated) {
  return is_file(stated) ? stated : find_shipped(stated).value_or(stated);
}

std::string nearest_shipped(const fs::path& stated) {
  if (shipped_folder().empty())
    return "; the configurations that saccade is shipped with were not found above its program: it "
           "wants share/saccade there";
  const std::string name = short_name(stated);
  std::vector<std::string> names = shipped_configurations();
  if (name.find('/') == std::string::npos)
    for (std::string& one : names) one = last_part(one);
  const auto near = nearest(name, names);
  return near ? "; did you mean '" + *near + "'?" : "";
}

}  // namespace saccade::config
