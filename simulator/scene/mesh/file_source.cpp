#include "simulator/scene/mesh/file_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "core/io/files/input_log.h"
#include "core/io/files/zip_archive.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kInside = "!/";

/// Where Debian packages put the scenes of the catalogue and the pictures of the shipped scenes
/// (docs/scenes.md).
struct PackageFiles {
  std::string_view prefix, package;  ///< files whose path begins with `prefix`
};
constexpr PackageFiles kPackages[] = {
    {"/usr/share/backgrounds/mate/", "mate-backgrounds"},
    {"/usr/share/backgrounds/Picture_", "lomiri-wallpapers-16.04"},
    {"/usr/share/backgrounds/aitzgorri_by_", "lomiri-wallpapers-16.04"},
    {"/usr/share/backgrounds/life_by_", "lomiri-wallpapers-16.04"},
    {"/usr/share/backgrounds/picosdeeuropa_by_", "lomiri-wallpapers-16.04"},
    {"/usr/share/sweethome3d/", "sweethome3d-furniture"},
    {"/usr/share/assimp/", "assimp-testmodels"},
    {"/usr/share/blender/datafiles/", "blender-data"},
    {"/usr/share/doc/castle-game-engine-doc/", "castle-game-engine-doc"},
    {"/usr/share/games/cube2/", "cube2-data"},
    {"/usr/share/games/flightgear/Models/", "flightgear-data-models"},
    {"/usr/share/games/openarena/baseoa/pak1-maps", "openarena-081-maps"},
    {"/usr/share/games/openarena/baseoa/pak4-textures", "openarena-081-textures"},
    {"/usr/share/games/torcs/", "torcs-data"},
};

/// Name of an archive's member: archives always separate by '/', and know no "..".
std::string member_name(const fs::path& file) {
  return file.lexically_normal().relative_path().generic_string();
}

bool is_equal_but_for_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::ranges::equal(a, b, [&](char x, char y) { return lower(x) == lower(y); });
}

std::optional<Bytes> read_from_disk(const fs::path& file) {
  if (!fs::is_regular_file(file)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string(), "cannot be opened for reading");
  Bytes bytes(std::istreambuf_iterator<char>(stream), {});
  if (stream.bad()) throw InputError(file.string(), "cannot be read to its end");
  return bytes;
}

}  // namespace

FileLocation FileLocation::parse(const fs::path& path) {
  const std::string text = path.string();
  const std::size_t inside = text.find(kInside);
  if (inside == std::string::npos) return {{}, path};
  return {text.substr(0, inside), text.substr(inside + kInside.size())};
}

std::string FileLocation::text() const {
  return archive.empty() ? file.string()
                         : archive.string() + std::string(kInside) + file.generic_string();
}

FileSource::FileSource(const fs::path& archive, Reporting reporting)
    : reporting_(reporting), archive_(archive) {
  if (archive.empty()) return;
  const std::string problem = missing_file_problem(archive);
  if (!problem.empty()) throw InputError(archive.string(), problem);
  zip_ = std::make_unique<ZipArchive>(archive);
}

FileSource::~FileSource() = default;
FileSource::FileSource(FileSource&&) noexcept = default;
FileSource& FileSource::operator=(FileSource&&) noexcept = default;

bool FileSource::contains(const fs::path& file) const {
  if (!zip_) return fs::is_regular_file(file);
  return zip_->contains(member_name(file));
}

std::optional<fs::path> FileSource::find(const fs::path& file) const {
  if (contains(file)) return file;
  if (zip_) {
    const std::string found = zip_->find_ignoring_case(member_name(file));
    if (found.empty()) return std::nullopt;
    return fs::path(found);
  }
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code none;
  std::optional<fs::path> found;  // the first in the order of names, whatever the disk's
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (is_equal_but_for_case(name, file.filename().string()) && entry.is_regular_file() &&
        (!found || name < found->filename().string()))
      found = file.parent_path() / name;
  }
  return found;
}

std::vector<fs::path> FileSource::list(const fs::path& folder) const {
  std::vector<fs::path> files;
  if (zip_) {
    const fs::path place(member_name(folder));
    for (const std::string& member : zip_->members())
      if (!member.ends_with('/') && fs::path(member).parent_path() == place)
        files.emplace_back(member);
  } else {
    std::error_code none;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(folder.empty() ? fs::path(".") : folder, none))
      if (entry.is_regular_file(none)) files.push_back(folder / entry.path().filename());
  }
  std::ranges::sort(files);
  return files;
}

std::optional<Bytes> FileSource::read(const fs::path& file) const {
  std::optional<Bytes> bytes = read_unreported(file);
  if (bytes && reporting_ == Reporting::kInputLog) {
    const fs::path name = zip_ ? fs::path(member_name(file)) : file;
    InputLog::note(FileLocation{archive_, name}.text(), std::as_bytes(std::span(*bytes)));
  }
  return bytes;
}

std::optional<Bytes> FileSource::read_unreported(const fs::path& file) const {
  if (!zip_) return read_from_disk(file);
  const std::string name = member_name(file);
  if (!zip_->contains(name)) return std::nullopt;
  ZipMember member(*zip_, name);
  const std::vector<std::byte> bytes = member.read_rest();
  if (bytes.size() != member.stated_size())
    throw InputError(zip_->location(name), "is damaged in its archive");
  const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
  return Bytes(first, first + bytes.size());
}

std::string missing_file_problem(const fs::path& path) {
  const FileLocation location = FileLocation::parse(path);
  const fs::path& file = location.archive.empty() ? location.file : location.archive;
  std::error_code error;  // of a name that is too long, or links in a circle
  if (fs::is_regular_file(file, error)) return {};
  for (const auto& [prefix, package] : kPackages)
    if (file.string().starts_with(prefix))
      return fmt::format("{} is missing: it is in the Debian package {}; apt-get install {}",
                         file.string(), package, package);
  if (error && error != std::errc::no_such_file_or_directory)
    return fmt::format("{}: {}", file.string(), error.message());
  return fmt::format("{} {}", file.string(),
                     fs::exists(file, error) ? "is not a file" : "does not exist");
}

}  // namespace saccade
