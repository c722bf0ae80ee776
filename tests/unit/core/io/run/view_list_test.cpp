#include "core/io/run/view_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

std::vector<RunView> two_views(const std::filesystem::path& folder) {
  std::vector<RunView> views(2);
  views[0].t_s = 0.125;
  views[0].world_from_camera = {so3_exp({0.1, 0.2, -0.3}), {1, 2, 3}};
  views[0].start_s = 0.1;
  views[0].end_s = 0.5;
  views[0].depth = folder / "depth" / "depth_00000000.exr";
  views[1].t_s = 1;
  views[1].image = folder / "image.exr";
  return views;
}

TEST(ViewList, ReadsWhatItWroteFromAnywhere) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "views.yaml";
  write_view_list(file, two_views(folder.path()));
  EXPECT_THAT(testing::read_file(file), HasSubstr("depth: depth/depth_00000000.exr"));
  const auto views = read_view_list(file);
  const auto expected = two_views(folder.path());
  ASSERT_EQ(views.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(views[i].t_s, expected[i].t_s);
    EXPECT_EQ(views[i].start_s, expected[i].start_s);
    EXPECT_EQ(views[i].end_s, expected[i].end_s);
    EXPECT_EQ(views[i].depth, expected[i].depth);
    EXPECT_EQ(views[i].image, expected[i].image);
    EXPECT_TRUE(views[i].gradient.empty());
    EXPECT_LT((views[i].world_from_camera.inverse() * expected[i].world_from_camera).log().norm(),
              1e-12);
  }
}

TEST(ViewList, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& yaml) {
    const auto file = folder.write("views.yaml", yaml);
    return error_of([&] { return read_view_list(file); });
  };
  const std::string pose =
      "T_world_camera: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]";
  EXPECT_EQ(error("{format_version: 1, views: [{t_s: 1, " + pose + "}]}"), "no error");
  EXPECT_THAT(error("{format_version: 2, views: []}"), HasSubstr("format_version"));
  EXPECT_THAT(error("{views: []}"), HasSubstr("format_version"));
  EXPECT_THAT(error("{format_version: 1, views: [{t_s: 1}]}"), HasSubstr("T_world_camera"));
  EXPECT_THAT(error("{format_version: 1, views: [{" + pose + "}]}"), HasSubstr("t_s"));
  EXPECT_THAT(error("{format_version: 1, views: [{t_s: 1, deepth: a, " + pose + "}]}"),
              HasSubstr("views.yaml:1"));
  EXPECT_THAT(error("{format_version: 1, views: [{t_s: 1, " + pose + "}, {t_s: 1, " + pose + "}]}"),
              HasSubstr("order of time"));
}

}  // namespace
}  // namespace saccade
