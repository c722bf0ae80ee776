#include "core/io/files/resumable_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <optional>

#include "core/io/files/input_log.h"
#include "core/io/files/sha256.h"
#include "core/io/tables/text_table.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_file;

class Resumable : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<ResumableFolder> open() const {
    return std::make_unique<ResumableFolder>(name_, "dataset.yaml", inputs_);
  }

  /// Lets another program do `work` in the folder, which is killed then.
  void killed(const std::function<void(ResumableFolder&)>& work) const {
    const pid_t child = fork();
    if (child == 0) {
      const auto target = open();
      work(*target);
      raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
  }

  const std::function<bool()> open_ = [this] { return open()->is_resumed(); };
  testing::TemporaryFolder folder_;
  const fs::path name_ = folder_.path() / "out";
  const fs::path workplace_ = folder_.path() / ".out.unfinished";
  Fingerprint inputs_{{"the configuration", "a"}, {"scene.obj", "b"}};
};

TEST_F(Resumable, AppearsWhenCommitted) {
  const auto target = open();
  EXPECT_FALSE(target->is_resumed());
  write_atomically(target->path() / "dataset.yaml", "a: 1\n");
  write_atomically(target->journal() / "checkpoint", "x");
  EXPECT_FALSE(fs::exists(name_));
  target->commit();
  EXPECT_EQ(read_file(name_ / "dataset.yaml"), "a: 1\n");
  EXPECT_FALSE(fs::exists(workplace_));
}

TEST_F(Resumable, AnExceptionLeavesNothing) {
  write_atomically(open()->path() / "f", "x");
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(Resumable, GoesOnAfterAKill) {
  killed([](ResumableFolder& target) {
    write_atomically(target.path() / "images/1.png", "one");
    write_atomically(target.journal() / "checkpoint", "x");
    std::ofstream(target.path() / "images/.2.png.partial-7-0") << "half";
  });
  const auto target = open();
  EXPECT_TRUE(target->is_resumed());
  EXPECT_EQ(target->refusal(), "");
  EXPECT_EQ(read_file(target->path() / "images/1.png"), "one");
  EXPECT_EQ(read_file(target->journal() / "checkpoint"), "x");
  EXPECT_FALSE(fs::exists(target->path() / "images/.2.png.partial-7-0"));
}

TEST_F(Resumable, StartsCleanWhereAnInputDiffers) {
  const auto leave = [&] {
    inputs_ = {{"the configuration", "a"}, {"scene.obj", "b"}};
    killed([](ResumableFolder& target) { write_atomically(target.path() / "f", "x"); });
  };
  const auto expect_clean = [&](const Fingerprint& now, const std::string& why) {
    leave();
    inputs_ = now;
    const auto target = open();
    EXPECT_FALSE(target->is_resumed());
    EXPECT_EQ(target->refusal(), why);
    EXPECT_TRUE(fs::is_empty(target->path()));
  };
  expect_clean({{"the configuration", "c"}, {"scene.obj", "b"}}, "the configuration differs");
  expect_clean({{"the configuration", "a"}, {"scene.obj", "c"}}, "scene.obj differs");
  expect_clean({{"the configuration", "a"}}, "scene.obj is not used any more");
  expect_clean({{"the configuration", "a"}, {"scene.obj", "b"}, {"sky.exr", "d"}},
               "sky.exr differs");
}

TEST_F(Resumable, StartsCleanFromDamagedLeftovers) {
  killed([](ResumableFolder& target) { write_atomically(target.path() / "f", "x"); });
  std::ofstream(workplace_ / "inputs.yaml") << "inputs: [";
  EXPECT_THAT(open()->refusal(), HasSubstr("inputs is damaged"));
  killed([](ResumableFolder& target) { fs::remove_all(target.journal()); });
  EXPECT_THAT(open()->refusal(), HasSubstr("missing"));
}

TEST_F(Resumable, GoesOnWhereOnlyTheNameIsMissing) {
  killed([](ResumableFolder& target) {
    write_atomically(target.path() / "dataset.yaml", "new");
    write_atomically(target.path().parent_path() / "complete",
                     sha256_of_file(target.path() / "dataset.yaml"));
  });
  EXPECT_TRUE(open()->is_resumed());
}

TEST_F(Resumable, StartsCleanAfterAKillBetweenNamingAndTidying) {
  killed([](ResumableFolder& target) {
    write_atomically(target.path() / "dataset.yaml", "the replaced one");
    write_atomically(target.path().parent_path() / "complete", "another hash");
  });
  const auto target = open();
  EXPECT_FALSE(target->is_resumed());
  EXPECT_TRUE(fs::is_empty(target->path()));
}

TEST_F(Resumable, RefusesASecondWriter) {
  const auto first = open();
  write_atomically(first->path() / "f", "x");
  EXPECT_THAT(error_of(open_), HasSubstr("out: is being written by another program"));
  EXPECT_TRUE(fs::exists(first->path() / "f"));
}

TEST_F(Resumable, SaysThatItsFolderWasTakenAway) {
  {
    const auto first = open();
    write_atomically(first->path() / "early", "x");
    fs::remove_all(first->path().parent_path());
    write_atomically(first->path() / "late", "x");
    write_atomically(first->path() / "dataset.yaml", "x");
    EXPECT_THAT(error_of([&] { return first->commit(), 0; }),
                HasSubstr(".out.unfinished: was removed by someone else"));
  }
  EXPECT_FALSE(fs::exists(name_));
  // A thread that was late leaves a part, without the lock.
  folder_.write(".out.unfinished/content/late", "x");
  const auto second = open();
  EXPECT_FALSE(second->is_resumed());
  EXPECT_FALSE(fs::exists(second->path() / "late"));
}

TEST_F(Resumable, LeavesForeignThingsAlone) {
  folder_.write("out/thesis.tex", "precious");
  EXPECT_THAT(error_of(open_), HasSubstr("exists and holds other files"));
  fs::remove_all(name_);
  folder_.write(".out.unfinished/thesis.tex", "precious");
  EXPECT_THAT(error_of(open_), HasSubstr("is in the way"));
  EXPECT_EQ(read_file(workplace_ / "thesis.tex"), "precious");
}

TEST_F(Resumable, InputsAreLoggedWithTheirHash) {
  const fs::path table = folder_.write("table.txt", "1 2\n");
  std::optional<InputLog> log(std::in_place);
  EXPECT_TRUE(log->files().empty());
  (void)read_number_table(table, "a b");
  EXPECT_EQ(log->files(), (std::map<std::string, std::string>{{table, sha256_of_file(table)}}));
  log.reset();
  (void)read_number_table(table, "a b");  // nobody listens
  EXPECT_TRUE(InputLog().files().empty());
}

TEST(Fingerprint, NamesWhatDiffers) {
  const Fingerprint before{{"a", "1"}, {"b", "2"}};
  EXPECT_EQ(difference(before, before), "");
  EXPECT_EQ(difference(before, {{"a", "1"}, {"b", "3"}}), "b differs");
  EXPECT_EQ(difference(before, {{"a", "1"}}), "b is not used any more");
  EXPECT_EQ(difference({}, {{"c", "1"}}), "c differs");
}

}  // namespace
}  // namespace saccade
