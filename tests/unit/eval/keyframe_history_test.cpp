#include "eval/keyframe_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_of.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

constexpr int kCount = 3;

class KeyframeHistoryTest : public testing::FakeFolders {
 protected:
  void SetUp() override {
    fs::copy(run(), odometry, fs::copy_options::recursive);
    testing::add_fake_keyframes(odometry, kCount);
  }

  [[nodiscard]] KeyframeHistory load() const {
    return KeyframeHistory::load(RunFolder::open(odometry)).value();
  }

  testing::TemporaryFolder folder;
  fs::path odometry = folder.path() / "odometry";
};

TEST_F(KeyframeHistoryTest, IsOfOdometryRunsAlone) {
  EXPECT_FALSE(KeyframeHistory::load(RunFolder::open(run())).has_value());
  const KeyframeHistory history = load();
  EXPECT_EQ(history.keyframes().size(), 3U);
  EXPECT_EQ(history.depth(2).points.size(), 80U * 60U);
  EXPECT_EQ(history.image(1)->t_s, history.keyframes()[1].t_s);
}

TEST_F(KeyframeHistoryTest, AKeyframeIsInForceAfterTheEventItWasTakenBy) {
  const KeyframeHistory history = load();
  EXPECT_EQ(history.in_force(-1), 0U);
  EXPECT_EQ(history.in_force(history.keyframes()[1].taken_s), 0U);
  EXPECT_EQ(history.in_force(history.keyframes()[1].taken_s + 1e-6), 1U);
  EXPECT_EQ(history.in_force(9), 2U);
}

TEST_F(KeyframeHistoryTest, TheMapOfATimeIsThatOfItsActiveKeyframes) {
  const std::vector<Eigen::Vector3f> all = RunFolder::open(odometry).load_map().positions;
  const std::size_t third = all.size() / 3;
  const std::vector<Eigen::Vector3f> second = load().map_at(0.055);
  ASSERT_NEAR(static_cast<double>(second.size()), static_cast<double>(third), 1);
  EXPECT_EQ(second.front(), all[third]);

  auto keyframes = read_keyframe_list(odometry / "keyframes.yaml");
  keyframes[2].active = {0, 2};
  write_keyframe_list(odometry / "keyframes.yaml", keyframes);
  const std::vector<Eigen::Vector3f> last = load().map_at(9);
  EXPECT_EQ(last.front(), all.front());
  EXPECT_EQ(last.back(), all.back());
  EXPECT_EQ(last.size(), all.size() - second.size());
}

TEST_F(KeyframeHistoryTest, RefusesFilesThatDoNotBelongTogether) {
  const auto keyframes = read_keyframe_list(odometry / "keyframes.yaml");
  auto fewer = keyframes;
  fewer.pop_back();
  write_keyframe_list(odometry / "keyframes.yaml", fewer);
  EXPECT_THAT(error_of([&] { return load(); }), HasSubstr("2 keyframes, views.yaml 3"));
  write_keyframe_list(odometry / "keyframes.yaml", {});
  EXPECT_THAT(error_of([&] { return load(); }), HasSubstr("no keyframe"));
  auto more_edges = keyframes;
  ++more_edges[0].edges;
  write_keyframe_list(odometry / "keyframes.yaml", more_edges);
  EXPECT_THAT(error_of([&] { return load(); }), HasSubstr("edges, map.ply holds"));
}

}  // namespace
}  // namespace saccade
