#include "core/io/files/folder_name.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(FolderName, IsTheLastPartHoweverItIsWritten) {
  EXPECT_EQ(folder_name("data/walls"), "walls");
  EXPECT_EQ(folder_name("data/walls/"), "walls");
  EXPECT_EQ(folder_name("data/walls/."), "walls");
  EXPECT_EQ(folder_name("data/planes/../walls"), "walls");
  EXPECT_EQ(folder_name("."), std::filesystem::current_path().filename().string());
}

TEST(FolderName, OfNothingIsNothing) { EXPECT_EQ(folder_name(""), ""); }

TEST(FolderName, ANamedFolderIsAbsolute) {
  EXPECT_EQ(named_folder("walls/"), std::filesystem::current_path() / "walls");
}

}  // namespace
}  // namespace saccade
