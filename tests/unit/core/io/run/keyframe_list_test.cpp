#include "core/io/run/keyframe_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

KeyframeEntry some_keyframe(double t_s) {
  KeyframeEntry keyframe;
  keyframe.t_s = t_s;
  keyframe.world_from_camera = {so3_exp({0.1, 0.2, 0.3}), {1, 2, 3}};
  keyframe.made_s = t_s + 0.1;
  keyframe.taken_s = t_s + 0.15;
  keyframe.events = 12345;
  keyframe.points = 678;
  keyframe.edges = 600;
  keyframe.typical_depth_m = 2.5;
  keyframe.active = {0, 1};
  return keyframe;
}

TEST(KeyframeList, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "keyframes.yaml";
  const std::vector<KeyframeEntry> keyframes{some_keyframe(0.5), some_keyframe(1)};
  write_keyframe_list(file, keyframes);
  const std::vector<KeyframeEntry> read = read_keyframe_list(file);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[1].t_s, 1);
  EXPECT_EQ(read[0].taken_s, keyframes[0].taken_s);
  EXPECT_EQ(read[0].events, 12345);
  EXPECT_EQ(read[0].active, keyframes[0].active);
  EXPECT_EQ(read[0].world_from_camera.translation(), keyframes[0].world_from_camera.translation());
}

TEST(KeyframeList, RefusesKeyframesOutOfOrder) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "keyframes.yaml";
  const std::vector<KeyframeEntry> keyframes{some_keyframe(1), some_keyframe(0.5)};
  const std::string error = error_of([&] {
    write_keyframe_list(file, keyframes);
    return read_keyframe_list(file);
  });
  EXPECT_THAT(error, HasSubstr("in order of time"));
}

TEST(KeyframeList, RefusesActiveKeyframesThatAreNotThere) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "keyframes.yaml";
  const std::string error = error_of([&] {
    write_keyframe_list(file, std::vector{some_keyframe(0.5)});
    return read_keyframe_list(file);
  });
  EXPECT_THAT(error, HasSubstr("active keyframe 1 is not among the 1"));
}

}  // namespace
}  // namespace saccade
