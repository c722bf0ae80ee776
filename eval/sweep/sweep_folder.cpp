#include "eval/sweep/sweep_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "core/error.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

namespace fs = std::filesystem;

void check_sweep_folder(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw InputError(folder.string(), "is not a folder");
  if (!fs::is_empty(folder) && !fs::exists(folder / "sweep.yaml"))
    throw InputError(folder.string(),
                     "is not empty and not a sweep (no sweep.yaml); choose another folder");
}

SweepFolderLock::SweepFolderLock(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) fail_to_write(folder, errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw InputError(folder.string(), "is being filled by another program at this moment");
}

SweepFolderLock::~SweepFolderLock() { ::close(descriptor_); }

}  // namespace saccade
