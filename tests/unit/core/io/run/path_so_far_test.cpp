#include "core/io/run/path_so_far.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "core/error.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

std::vector<StampedPose> straight(std::size_t count) {
  std::vector<StampedPose> path;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 0.001 * static_cast<double>(i);
    path.push_back({x, Rigid3(Eigen::Quaterniond::Identity(), {x, 0, 0})});
  }
  return path;
}

TEST(PathSoFar, IsReadBack) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_path_so_far(folder.path()));
  PathSoFar(folder.path(), "/data/./a walk").show(straight(5));
  const auto shown = read_path_so_far(folder.path());
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->dataset, "/data/a walk");
  ASSERT_EQ(shown->path.size(), 5U);
  EXPECT_EQ(shown->path.poses()[3].world_from_camera.translation().x(), 0.003);
  remove_path_so_far(folder.path());
  EXPECT_TRUE(fs::is_empty(folder.path()));
  remove_path_so_far(folder.path());  // which it may be asked for twice
}

TEST(PathSoFar, ALongPathIsThinnedToItsEnds) {
  const TemporaryFolder folder;
  const auto path = straight(10'000);
  PathSoFar(folder.path(), "/data").show(path);
  const auto shown = read_path_so_far(folder.path());
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->path.size(), PathSoFar::kMostPoses);
  EXPECT_EQ(shown->path.start_s(), path.front().t_s);
  EXPECT_NEAR(shown->path.end_s(), path.back().t_s, 1e-9);
}

TEST(PathSoFar, IsNotWrittenAgainAtOnce) {
  const TemporaryFolder folder;
  PathSoFar so_far(folder.path(), "/data");
  so_far.show({});
  EXPECT_FALSE(read_path_so_far(folder.path())) << "there is no path without poses";
  so_far.show(straight(2));
  so_far.show(straight(3));
  EXPECT_EQ(read_path_so_far(folder.path())->path.size(), 2U);
}

TEST(PathSoFar, TheNewestIsReadAndTheOneBeforeIsGone) {
  const TemporaryFolder folder;
  folder.write("path_so_far.00000006.txt", "# /data\n0 0 0 0 0 0 0 1\n");
  folder.write("path_so_far.00000007.txt", "# /data\n0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(read_path_so_far(folder.path())->path.size(), 2U);
  remove_path_so_far(folder.path());
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(PathSoFar, WhatCannotBeWrittenIsNotShown) {
  const TemporaryFolder folder;
  PathSoFar(folder.path() / "gone", "/data").show(straight(2));
  EXPECT_FALSE(read_path_so_far(folder.path() / "gone"));
}

TEST(PathSoFar, WhatIsMalformedIsAnError) {
  const TemporaryFolder folder;
  folder.write("path_so_far.00000000.txt", "# /data\n0 1 2\n");
  EXPECT_THROW(static_cast<void>(read_path_so_far(folder.path())), InputError);
  folder.write("path_so_far.00000000.txt", "0 0 0 0 0 0 0 1\n");
  EXPECT_FALSE(read_path_so_far(folder.path())) << "it names no dataset";
}

}  // namespace
}  // namespace saccade
