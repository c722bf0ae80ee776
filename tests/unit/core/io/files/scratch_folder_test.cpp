#include "core/io/files/scratch_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// The environment's TMPDIR as it was before, back at the end.
class TemporaryPlace {
 public:
  explicit TemporaryPlace(const fs::path& place) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", place.c_str(), 1);
  }
  ~TemporaryPlace() {
    if (before_)
      ::setenv("TMPDIR", before_->c_str(), 1);
    else
      ::unsetenv("TMPDIR");
  }
  TemporaryPlace(const TemporaryPlace&) = delete;
  TemporaryPlace& operator=(const TemporaryPlace&) = delete;

 private:
  std::optional<std::string> before_;
};

TEST(ScratchFolder, IsGoneWithAllThatItHolds) {
  fs::path path;
  {
    const ScratchFolder folder;
    path = folder.path();
    EXPECT_TRUE(fs::is_empty(path));
    fs::create_directories(path / "deep");
    std::ofstream(path / "deep" / "file.txt") << "text";
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(ScratchFolder, TwoAreApart) {
  const ScratchFolder first, second;
  EXPECT_NE(first.path(), second.path());
}

TEST(ScratchFolder, StandsWhereTheEnvironmentSays) {
  const testing::TemporaryFolder place;
  const TemporaryPlace set(place.path());
  EXPECT_EQ(ScratchFolder().path().parent_path(), place.path());
}

TEST(ScratchFolder, NamesThePlaceThatDoesNotExist) {
  const testing::TemporaryFolder place;
  const fs::path missing = place.path() / "missing";
  const TemporaryPlace set(missing);
  const std::string error = testing::error_of([] { const ScratchFolder folder; });
  EXPECT_NE(error.find(missing.string()), std::string::npos) << error;
  EXPECT_NE(error.find("TMPDIR"), std::string::npos) << error;
}

}  // namespace
}  // namespace saccade
