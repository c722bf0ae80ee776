#include "core/io/files/atomic_file.h"

#include <fcntl.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/unfinished_sibling.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

/// Absolute, without dots and without a slash at the end; what a link points to, so that the link
/// stays.
fs::path final_name(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  const fs::path name = whole.has_filename() ? whole : whole.parent_path();
  if (name.filename().empty()) throw InputError(path.string(), "is no name to write to");
  return fs::is_symlink(name) && fs::exists(name) ? fs::canonical(name) : name;
}

void create_parent_of(const fs::path& target) {
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  if (error)
    throw InputError(target.string(),
                     "cannot create the folder it should stand in: " + error.message());
}

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw InputError(to.string(), "cannot be put in place: " + error.message());
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& file)
    : target_(final_name(file)), temporary_(unfinished_sibling(target_, "partial")) {
  create_parent_of(target_);
  remove_abandoned_siblings(target_.parent_path());
  if (fs::is_directory(target_)) throw InputError(file.string(), "is a folder, not a file");
  if (fs::exists(target_) && !fs::is_regular_file(target_))
    throw InputError(file.string(), "is a device or the like, which cannot be replaced by a file");
  // Fails here rather than after the work when the place is not writable.
  errno = 0;
  if (!std::ofstream(path())) fail_to_write(file, errno);
}

AtomicFile::~AtomicFile() = default;

void AtomicFile::commit() {
  SACCADE_CHECK(!committed_);
  rename_or_throw(path(), target_);
  committed_ = true;
}

void write_atomically(const fs::path& file, std::string_view contents) {
  AtomicFile target(file);
  errno = 0;
  std::ofstream stream(target.path(), std::ios::binary);
  stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
  stream.close();
  if (!stream) fail_to_write(file, errno);
  target.commit();
}

void fail_to_write(const fs::path& file, int error) {
  std::string problem = "cannot be written";
  if (error != 0) problem += std::string(": ") + std::strerror(error);
  if (error == ENOSPC || error == EDQUOT || error == EFBIG)
    problem += "; make room there or write to another place";
  throw InputError(file.string(), problem);
}

FinalFolder::FinalFolder(const fs::path& folder, std::string marker)
    : path_(final_name(folder)), marker_(std::move(marker)) {}

void FinalFolder::check_replaceable() const {
  if (!fs::exists(fs::symlink_status(path_))) return;
  if (!fs::is_directory(path_)) throw InputError(path_.string(), "exists and is no folder");
  if (!fs::is_empty(path_) && !fs::exists(path_ / marker_))
    throw InputError(path_.string(), "exists and holds other files (no " + marker_ +
                                         " in it); choose another name or remove it");
}

void FinalFolder::create_parent() const { create_parent_of(path_); }

void FinalFolder::take(const fs::path& complete) const {
  check_replaceable();
  // Without it the folder would be taken for somebody else's. Files make the folders above them
  // anew, so that one which was removed meanwhile goes on with a part of its content.
  if (!fs::exists(complete / marker_))
    throw InputError(complete.string(), "was removed by someone else while it was written");
  if (!fs::exists(path_)) return rename_or_throw(complete, path_);
  // Exchanged in one step where the file system can, so that the name is never without a folder.
  fs::path old = complete;
  if (::renameat2(AT_FDCWD, complete.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0) {
    old = unfinished_sibling(path_, "old");
    rename_or_throw(path_, old);
    try {
      rename_or_throw(complete, path_);
    } catch (const InputError&) {
      rename_or_throw(old, path_);  // the former result stays what it was
      throw;
    }
  }
  // The result stands; what cannot be removed is hidden and in nobody's way.
  std::error_code ignored;
  fs::remove_all(old, ignored);
}

AtomicFolder::AtomicFolder(const fs::path& folder, std::string marker)
    : final_(folder, std::move(marker)), temporary_(unfinished_sibling(final_.path(), "partial")) {
  final_.check_replaceable();
  final_.create_parent();
  remove_abandoned_siblings(target().parent_path());
  std::error_code error;
  fs::create_directory(path(), error);
  if (error) throw InputError(folder.string(), "cannot be created: " + error.message());
}

AtomicFolder::~AtomicFolder() = default;

void AtomicFolder::commit() {
  SACCADE_CHECK(!committed_);
  final_.take(path());
  committed_ = true;
}

}  // namespace saccade
