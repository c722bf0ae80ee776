#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace saccade {

class ZipArchive;

/// A file on disk, or a member of a zip archive: "furniture.sh3f!/desk/desk.obj".
struct FileLocation {
  std::filesystem::path archive;  ///< empty: on disk
  std::filesystem::path file;     ///< in the archive without a leading slash

  [[nodiscard]] static FileLocation parse(const std::filesystem::path& path);
  [[nodiscard]] std::string text() const;
};

using Bytes = std::vector<unsigned char>;

/// Reads whole files from one place: the disk or one archive. Not thread-safe.
class FileSource {
 public:
  /// Whether what is read is noted in the InputLog.
  enum class Reporting { kInputLog, kNone };

  /// Of the disk when `archive` is empty. Throws InputError when the archive cannot be opened.
  explicit FileSource(const std::filesystem::path& archive = {},
                      Reporting reporting = Reporting::kInputLog);
  ~FileSource();
  FileSource(FileSource&&) noexcept;
  FileSource& operator=(FileSource&&) noexcept;

  [[nodiscard]] bool contains(const std::filesystem::path& file) const;
  /// The file as it is called here: names from Windows may differ in case. nullopt when there is none.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::filesystem::path& file) const;
  /// nullopt when the file is missing. Throws InputError when it cannot be read to its end.
  [[nodiscard]] std::optional<Bytes> read(const std::filesystem::path& file) const;
  /// The files that are in a folder itself, by their names; none where there is no such folder.
  [[nodiscard]] std::vector<std::filesystem::path> list(const std::filesystem::path& folder) const;
  [[nodiscard]] const std::filesystem::path& archive() const { return archive_; }

 private:
  [[nodiscard]] std::optional<Bytes> read_unreported(const std::filesystem::path& file) const;

  Reporting reporting_;
  std::filesystem::path archive_;
  std::unique_ptr<ZipArchive> zip_;
};

/// What is wrong when nothing is at `path` (of an archive's member: no archive), with the way to
/// get it where that is known; "" when it is there.
[[nodiscard]] std::string missing_file_problem(const std::filesystem::path& path);

}  // namespace saccade
