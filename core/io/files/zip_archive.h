#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct zip;
struct zip_file;

namespace saccade {

/// A zip archive that is read. InputError with the path where it cannot be opened.
class ZipArchive {
 public:
  explicit ZipArchive(const std::filesystem::path& file);

  /// In the order of the archive; folders end in '/'.
  [[nodiscard]] const std::vector<std::string>& members() const { return members_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The member as it is called here, "" where there is none; names from Windows may differ in case.
  [[nodiscard]] bool contains(const std::string& member) const;
  [[nodiscard]] std::string find_ignoring_case(const std::string& member) const;
  /// "archive!/member", as locations of errors.
  [[nodiscard]] std::string location(const std::string& member) const {
    return name_ + "!/" + member;
  }

 private:
  friend class ZipMember;
  struct Close {
    void operator()(zip* archive) const;
  };

  std::string name_;
  std::unique_ptr<zip, Close> archive_;
  std::vector<std::string> members_;
};

/// A member of an archive that is unpacked from front to back. Several can be at once; the archive
/// outlives them.
class ZipMember {
 public:
  ZipMember(ZipArchive& archive, const std::string& member);
  /// Fills `bytes`; returns how many there were, fewer only at the end. InputError with the
  /// location where the archive is damaged.
  [[nodiscard]] std::size_t read(std::span<std::byte> bytes);
  /// What is left of the member. Memory follows what is really unpacked; InputError with the location
  /// where that is more than kMostWholeBytes.
  [[nodiscard]] std::vector<std::byte> read_rest();
  /// Of the whole member, as the archive states it [bytes].
  [[nodiscard]] std::uint64_t stated_size() const { return stated_size_; }

  /// A few kilobytes of zeros may be packed into a byte.
  static constexpr std::uint64_t kMostWholeBytes = std::uint64_t{1} << 30U;

 private:
  struct Close {
    void operator()(zip_file* file) const;
  };

  std::string location_;
  std::unique_ptr<zip_file, Close> file_;
  std::uint64_t stated_size_ = 0;
};

/// Writes a zip archive of files without compressing them; `files`: name in the archive and path.
/// The bytes depend on theirs alone. InputError with the path where that fails.
void write_zip(const std::filesystem::path& target,
               const std::vector<std::pair<std::string, std::filesystem::path>>& files);

}  // namespace saccade
