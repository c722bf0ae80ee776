#include "core/io/files/file_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <utility>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// A pipe over which one process tells another to go on.
class Signal {
 public:
  Signal() {
    if (::pipe(ends_.data()) != 0) ADD_FAILURE() << "no pipe";
  }
  ~Signal() {
    for (const int end : ends_)
      if (end >= 0) ::close(end);
  }
  Signal(const Signal&) = delete;
  Signal& operator=(const Signal&) = delete;

  /// Each process keeps one end, so that who waits for one that has died is not left waiting.
  void keep_sender() { ::close(std::exchange(ends_[0], -1)); }
  void keep_receiver() { ::close(std::exchange(ends_[1], -1)); }
  void send() const { EXPECT_EQ(::write(ends_[1], "!", 1), 1); }
  void wait() const {
    char sign = 0;
    EXPECT_EQ(::read(ends_[0], &sign, 1), 1) << "the other process has died";
  }

 private:
  std::array<int, 2> ends_{};
};

/// Another process that takes the lock when it is told to, and holds it until it is killed. Forked
/// before this one has the lock, which a copy of its descriptor would share.
class OtherProcess {
 public:
  explicit OtherProcess(const fs::path& file) : child_(fork()) {
    if (child_ != 0) {
      go_.keep_sender();
      has_lock_.keep_receiver();
      return;
    }
    go_.keep_receiver();
    has_lock_.keep_sender();
    try {
      go_.wait();
      const FileLock lock = FileLock::wait_for(file);
      has_lock_.send();
      for (;;) pause();
    } catch (...) {  // must not go on as a second program of tests
    }
    _exit(1);
  }
  ~OtherProcess() { end(); }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;

  void ask_for_lock() const { go_.send(); }
  void wait_until_it_has_the_lock() const { has_lock_.wait(); }
  /// Until it waits for the lock: a file that it has opened.
  void wait_until_it_has_opened(const fs::path& file) const {
    const fs::path descriptors = "/proc/" + std::to_string(child_) + "/fd";
    for (bool found = false; !found;) {
      std::error_code gone;
      for (const fs::directory_entry& entry : fs::directory_iterator(descriptors, gone))
        found = found || fs::read_symlink(entry, gone) == file;
      ASSERT_FALSE(::waitpid(child_, nullptr, WNOHANG) == child_) << "the other process has died";
    }
  }
  void end() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(std::exchange(child_, 0), nullptr, 0);
  }

 private:
  Signal go_, has_lock_;
  pid_t child_;
};

class Locking : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path file() const { return folder_.path() / "entry/lock"; }

  testing::TemporaryFolder folder_;
};

TEST_F(Locking, IsFreeAgainWhenItsOwnerIsKilled) {
  OtherProcess other(file());
  other.ask_for_lock();
  other.wait_until_it_has_the_lock();
  EXPECT_FALSE(FileLock::try_take(file()));
  other.end();
  EXPECT_TRUE(FileLock::try_take(file()));
}

TEST_F(Locking, AnotherProcessGetsItWhenItIsGivenUp) {
  const OtherProcess other(file());
  std::optional<FileLock> mine = FileLock::try_take(file());
  ASSERT_TRUE(mine);
  other.ask_for_lock();
  mine.reset();
  other.wait_until_it_has_the_lock();
  EXPECT_FALSE(FileLock::try_take(file()));
}

/// Who waited for a file that its owner removed holds a lock on nothing: it must take the new one.
TEST_F(Locking, AFileRemovedByItsOwnerIsLockedAnew) {
  const OtherProcess other(file());
  std::optional<FileLock> mine = FileLock::try_take(file());
  other.ask_for_lock();
  other.wait_until_it_has_opened(file());
  fs::remove_all(file().parent_path());
  mine.reset();
  other.wait_until_it_has_the_lock();
  EXPECT_TRUE(fs::exists(file()));
  EXPECT_FALSE(FileLock::try_take(file()));
}

TEST_F(Locking, IsHandedOnByMoving) {
  FileLock first = FileLock::wait_for(file());
  {
    const FileLock second = std::move(first);
    EXPECT_FALSE(FileLock::try_take(file()));
  }
  EXPECT_TRUE(FileLock::try_take(file()));
}

TEST_F(Locking, NamesTheFolderThatCannotBe) {
  const fs::path text = folder_.write("text", "not a folder\n");
  EXPECT_EQ(testing::error_of([&] {
              return FileLock::try_take(text / "lock").has_value();
            }).substr(0, text.string().size()),
            text.string());
}

}  // namespace
}  // namespace saccade
