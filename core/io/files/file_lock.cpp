#include "core/io/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

bool is_same_file(int descriptor, const fs::path& file) {
  struct stat open_one {};
  struct stat named {};
  return ::fstat(descriptor, &open_one) == 0 && ::stat(file.c_str(), &named) == 0 &&
         open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

int open_lock(const fs::path& file) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) throw InputError(file.parent_path().string(), "cannot be created: " + error.message());
  return ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
}

}  // namespace

FileLock FileLock::wait_for(const fs::path& file) { return *take(file, LOCK_EX); }

std::optional<FileLock> FileLock::try_take(const fs::path& file) {
  return take(file, LOCK_EX | LOCK_NB);
}

std::optional<FileLock> FileLock::take(const fs::path& file, int operation) {
  for (;;) {
    const int descriptor = open_lock(file);
    // Its last owner may have removed the folder meanwhile.
    if (descriptor < 0 && errno == ENOENT) continue;
    if (descriptor < 0) fail_to_write(file, errno);
    FileLock lock(descriptor);
    while (::flock(descriptor, operation) != 0) {
      if (errno == EWOULDBLOCK) return std::nullopt;
      if (errno != EINTR) fail_to_write(file, errno);
    }
    if (is_same_file(descriptor, file)) return lock;
  }
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace saccade
