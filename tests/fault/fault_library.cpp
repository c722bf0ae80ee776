// Preloaded into a program (LD_PRELOAD) it makes calls of the system fail as a bad disk does:
//   SACCADE_FAULT        KIND:N, the N-th call (from 1) of that kind fails, once. Kinds: no-space and io-error (of a write),
//                        short-write (half is written), interrupted (EINTR), create, rename, sync, truncate; and pause:
//                        the N-th call of any of these kinds never returns, so that the program can be met at that place
//   SACCADE_FAULT_UNDER  the folder whose files are meant; other files are as they are
//   SACCADE_FAULT_COUNT  a file to which the number of calls of the kind is written whenever it grows

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

enum class Kind {
  kNone,
  kNoSpace,
  kIoError,
  kShortWrite,
  kInterrupted,
  kCreate,
  kRename,
  kSync,
  kTruncate,
  kPause
};

struct Plan {
  Kind kind = Kind::kNone;
  long number = 0;
  std::string under;
  const char* count_file = nullptr;
  std::atomic<long> calls{0};

  Plan() {
    const char* fault = std::getenv("SACCADE_FAULT");
    const char* folder = std::getenv("SACCADE_FAULT_UNDER");
    if (fault == nullptr || folder == nullptr) return;
    under = folder;
    count_file = std::getenv("SACCADE_FAULT_COUNT");
    const std::string text = fault;
    const std::size_t colon = text.find(':');
    number = std::atol(text.c_str() + colon + 1);
    constexpr struct {
      const char* name;
      Kind kind;
    } kKinds[] = {{"no-space", Kind::kNoSpace},
                  {"io-error", Kind::kIoError},
                  {"short-write", Kind::kShortWrite},
                  {"interrupted", Kind::kInterrupted},
                  {"create", Kind::kCreate},
                  {"rename", Kind::kRename},
                  {"sync", Kind::kSync},
                  {"truncate", Kind::kTruncate},
                  {"pause", Kind::kPause}};
    for (const auto& known : kKinds)
      if (text.compare(0, colon, known.name) == 0) kind = known.kind;
  }
};

Plan& plan() {
  static auto* const all = new Plan;
  return *all;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_meant(const char* path) {
  return !plan().under.empty() &&
         std::strncmp(path, plan().under.c_str(), plan().under.size()) == 0;
}

bool is_meant(int descriptor) {
  if (plan().kind == Kind::kNone) return false;
  char link[64];
  char path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t size = ::readlink(link, path, sizeof path - 1);
  if (size <= 0) return false;
  path[size] = '\0';
  return is_meant(path);
}

/// Whether the call that is about to be made is the one that fails; the one that pauses stays here.
bool fails_now() {
  const long call = ++plan().calls;
  if (plan().count_file != nullptr) {
    static const auto open_file = next<int (*)(const char*, int, ...)>("open");
    static const int file = open_file(plan().count_file, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    char text[24];
    const int length = std::snprintf(text, sizeof text, "%ld\n", call);
    static const auto pwrite_file = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
    [[maybe_unused]] const ssize_t written =
        pwrite_file(file, text, static_cast<size_t>(length), 0);
  }
  const bool is_the_one = call == plan().number;
  while (is_the_one && plan().kind == Kind::kPause) ::pause();
  return is_the_one;
}

bool is_write_fault() {
  return plan().kind == Kind::kNoSpace || plan().kind == Kind::kIoError ||
         plan().kind == Kind::kShortWrite || plan().kind == Kind::kInterrupted ||
         plan().kind == Kind::kPause;
}

/// Makes a write of `size` bytes fail: true with errno, or a shorter `size`.
bool spoil_write(int descriptor, size_t& size) {
  if (!is_write_fault() || !is_meant(descriptor) || !fails_now()) return false;
  if (plan().kind == Kind::kShortWrite) {
    size = size > 1 ? size / 2 : size;
    return false;
  }
  errno = plan().kind == Kind::kNoSpace ? ENOSPC : plan().kind == Kind::kIoError ? EIO : EINTR;
  return true;
}

bool concerns(Kind kind) { return plan().kind == kind || plan().kind == Kind::kPause; }

bool spoils(Kind kind, const char* path) { return concerns(kind) && is_meant(path) && fails_now(); }
bool spoils(Kind kind, int descriptor) {
  return concerns(kind) && is_meant(descriptor) && fails_now();
}

int fail_with(int error) {
  errno = error;
  return -1;
}

mode_t mode_of(int flags, va_list arguments) {
  return (flags & O_CREAT) != 0 ? static_cast<mode_t>(va_arg(arguments, int)) : 0;
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  return spoil_write(descriptor, size) ? -1 : real(descriptor, bytes, size);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
  size_t size = 2;
  if (spoil_write(descriptor, size)) return -1;
  return size == 2 ? real(descriptor, parts, count) : real(descriptor, parts, 1);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  return spoil_write(descriptor, size) ? -1 : real(descriptor, bytes, size, offset);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t offset) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  return spoil_write(descriptor, size) ? -1 : real(descriptor, bytes, size, offset);
}

int fsync(int descriptor) {
  static const auto real = next<int (*)(int)>("fsync");
  return spoils(Kind::kSync, descriptor) ? fail_with(EIO) : real(descriptor);
}

int fdatasync(int descriptor) {
  static const auto real = next<int (*)(int)>("fdatasync");
  return spoils(Kind::kSync, descriptor) ? fail_with(EIO) : real(descriptor);
}

int ftruncate(int descriptor, off_t size) noexcept {
  static const auto real = next<int (*)(int, off_t)>("ftruncate");
  return spoils(Kind::kTruncate, descriptor) ? fail_with(EIO) : real(descriptor, size);
}

int ftruncate64(int descriptor, off64_t size) noexcept {
  static const auto real = next<int (*)(int, off64_t)>("ftruncate64");
  return spoils(Kind::kTruncate, descriptor) ? fail_with(EIO) : real(descriptor, size);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return spoils(Kind::kRename, to) ? fail_with(EIO) : real(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) noexcept {
  static const auto real = next<int (*)(int, const char*, int, const char*, unsigned)>("renameat2");
  return spoils(Kind::kRename, to) ? fail_with(EINVAL)
                                   : real(from_folder, from, to_folder, to, flags);
}

int open(const char* path, int flags, ...) {
  static const auto real = next<int (*)(const char*, int, ...)>("open");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  if ((flags & O_CREAT) != 0 && spoils(Kind::kCreate, path)) return fail_with(EMFILE);
  return real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  static const auto real = next<int (*)(const char*, int, ...)>("open64");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  if ((flags & O_CREAT) != 0 && spoils(Kind::kCreate, path)) return fail_with(EMFILE);
  return real(path, flags, mode);
}

int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = next<int (*)(const char*, mode_t)>("mkdir");
  return spoils(Kind::kCreate, path) ? fail_with(EIO) : real(path, mode);
}

}  // extern "C"
