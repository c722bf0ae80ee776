#include "simulator/scene/mesh/quake3/quake3_files.h"

#include <algorithm>
#include <system_error>

#include "core/error.h"
#include "simulator/scene/mesh/quake3/quake3_map.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// The other archives of a folder, the last by name first.
std::vector<fs::path> archives_of(const fs::path& folder, const fs::path& but) {
  std::vector<fs::path> archives;
  std::error_code none;
  const fs::path place = folder.empty() ? fs::path(".") : folder;
  for (const fs::directory_entry& entry : fs::directory_iterator(place, none)) {
    const fs::path path = folder / entry.path().filename();
    if (is_quake3_archive(path) && path != but && entry.is_regular_file(none))
      archives.push_back(path);
  }
  std::ranges::sort(archives, std::ranges::greater());
  return archives;
}

}  // namespace

Quake3Files::Quake3Files(const FileSource& own, const fs::path& map) : own_(own) {
  fs::path folder = map.parent_path().lexically_normal();
  // A file that is named from within its folder.
  const bool is_relative = folder.empty() || folder.filename() == "." || folder.filename() == "..";
  if (own.archive().empty() && is_relative)
    folder = fs::absolute(map).lexically_normal().parent_path();
  root_ = folder.filename() == "maps" ? folder.parent_path() : folder;
  const fs::path beside = own.archive().empty() ? root_ : own.archive().parent_path();
  for (const fs::path& archive : archives_of(beside, own.archive())) try {
      archives_.emplace_back(archive);
    } catch (const InputError& error) {
      problems_.emplace_back(error.what());
    }
}

std::vector<const FileSource*> Quake3Files::sources() const {
  std::vector<const FileSource*> all{&own_};
  for (const FileSource& archive : archives_) all.push_back(&archive);
  return all;
}

fs::path Quake3Files::path_in(const FileSource& source, const fs::path& file) const {
  return &source == &own_ ? root_ / file : file;
}

std::optional<Quake3Files::Found> Quake3Files::picture(const std::string& name) const {
  const fs::path stated = fs::path(name).lexically_normal();
  for (const FileSource* source : sources())
    for (const char* ending : {"", ".tga", ".jpg", ".png"}) {
      fs::path file = stated;
      if (*ending != '\0') file.replace_extension(ending);
      if (!file.has_extension()) continue;
      if (const auto found = source->find(path_in(*source, file))) return Found{source, *found};
    }
  return std::nullopt;
}

std::vector<Quake3Files::Found> Quake3Files::scripts() const {
  std::vector<Found> scripts;
  for (const FileSource* source : sources())
    for (const fs::path& file : source->list(path_in(*source, "scripts")))
      if (file.extension() == ".shader") scripts.push_back({source, file});
  return scripts;
}

std::string Quake3Files::places() const {
  std::string text = own_.archive().empty() ? root_.string() : own_.archive().string();
  for (const FileSource& archive : archives_) text += ", " + archive.archive().filename().string();
  return text;
}

}  // namespace saccade
