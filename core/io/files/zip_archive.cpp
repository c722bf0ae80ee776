#include "core/io/files/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include "core/error.h"

namespace saccade {
namespace {

std::string zip_reason(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string reason = zip_error_strerror(&error);
  zip_error_fini(&error);
  return reason;
}

}  // namespace

void ZipArchive::Close::operator()(zip* archive) const { zip_discard(archive); }
void ZipMember::Close::operator()(zip_file* file) const { zip_fclose(file); }

ZipArchive::ZipArchive(const std::filesystem::path& file) : name_(file.string()) {
  int code = 0;
  archive_.reset(zip_open(name_.c_str(), ZIP_RDONLY, &code));
  if (archive_ == nullptr)
    throw InputError(name_, "cannot be opened as a zip archive: " + zip_reason(code));
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* member = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    if (member != nullptr) members_.emplace_back(member);
  }
}

bool ZipArchive::contains(const std::string& member) const {
  return zip_name_locate(archive_.get(), member.c_str(), 0) >= 0;
}

std::string ZipArchive::find_ignoring_case(const std::string& member) const {
  const zip_int64_t index = zip_name_locate(archive_.get(), member.c_str(), ZIP_FL_NOCASE);
  return index < 0 ? "" : zip_get_name(archive_.get(), static_cast<zip_uint64_t>(index), 0);
}

ZipMember::ZipMember(ZipArchive& archive, const std::string& member)
    : location_(archive.location(member)),
      file_(zip_fopen(archive.archive_.get(), member.c_str(), 0)) {
  if (file_ == nullptr)
    throw InputError(location_, fmt::format("cannot be read in this archive: {}",
                                            zip_strerror(archive.archive_.get())));
  zip_stat_t stat;
  if (zip_stat(archive.archive_.get(), member.c_str(), 0, &stat) == 0 &&
      (stat.valid & ZIP_STAT_SIZE) != 0)
    stated_size_ = stat.size;
}

std::size_t ZipMember::read(std::span<std::byte> bytes) {
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const zip_int64_t count = zip_fread(file_.get(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0)
      throw InputError(location_,
                       fmt::format("cannot be unpacked: {}", zip_file_strerror(file_.get())));
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  return filled;
}

std::vector<std::byte> ZipMember::read_rest() {
  constexpr std::size_t kBlock = std::size_t{1} << 20U;
  std::vector<std::byte> bytes;
  for (std::size_t count = kBlock; count == kBlock;) {
    const std::size_t before = bytes.size();
    if (before > kMostWholeBytes)
      throw InputError(location_, fmt::format("unpacks to more than {} bytes", kMostWholeBytes));
    bytes.resize(before + kBlock);
    count = read(std::span(bytes).subspan(before));
    bytes.resize(before + count);
  }
  return bytes;
}

void write_zip(const std::filesystem::path& target,
               const std::vector<std::pair<std::string, std::filesystem::path>>& files) {
  int code = 0;
  zip_t* archive = zip_open(target.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (archive == nullptr)
    throw InputError(target.string(), "cannot be written: " + zip_reason(code));
  bool is_good = true;
  for (const auto& [name, path] : files) {
    zip_source_t* source = zip_source_file(archive, path.c_str(), 0, -1);
    const zip_int64_t index =
        source == nullptr ? -1 : zip_file_add(archive, name.c_str(), source, 0);
    if (source != nullptr && index < 0) zip_source_free(source);
    constexpr std::time_t kFirstOfDos = 315'532'800;  // 1980: no time of writing
    is_good =
        is_good && index >= 0 &&
        zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0) == 0 &&
        zip_file_set_mtime(archive, static_cast<zip_uint64_t>(index), kFirstOfDos, 0) == 0;
  }
  if (is_good && zip_close(archive) == 0) return;
  const std::string reason = zip_strerror(archive);
  zip_discard(archive);
  throw InputError(target.string(),
                   "cannot be written: " + reason + "; make room there or write to another place");
}

}  // namespace saccade
