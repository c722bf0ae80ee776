#include "apps/convert_grids.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <vector>

#include "core/io/dataset/dataset_writer.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class ConvertGrids : public ::testing::Test {
 protected:
  /// Three ON events and one OFF event, and frames at 0, 0.05 and 0.1 s.
  void SetUp() override {
    DatasetWriter writer(dataset_, {8, 6, 10, 10, 3.5, 2.5, {}});
    const Events events{{10'000'000, 1, 2, 1},
                        {20'000'000, 1, 2, 1},
                        {50'000'000, 7, 5, -1},
                        {90'000'000, 0, 0, 1}};
    writer.write_events(events);
    for (std::size_t i = 0; i < 3; ++i)
      writer.write_frame(i, 0.05 * static_cast<double>(i), ImageF(8, 6, 0.5F));
    static_cast<void>(writer.finish({}));
  }

  /// The values of grids of a request, by way of npy.
  [[nodiscard]] std::vector<float> values(const GridRequest& request) const {
    const std::filesystem::path file = folder_.path() / "grids.npy";
    static_cast<void>(convert_to_grids(dataset_, file, request));
    const std::string bytes = testing::read_file(file);
    const std::size_t start = 10 + static_cast<unsigned char>(bytes[8]);
    std::vector<float> values((bytes.size() - start) / sizeof(float));
    std::memcpy(values.data(), bytes.data() + start, values.size() * sizeof(float));
    return values;
  }

  TemporaryFolder folder_;
  std::filesystem::path dataset_ = folder_.path() / "data";
};

float sum(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0F);
}

TEST_F(ConvertGrids, VoxelGridsOfADatasetSumUpToItsEvents) {
  const std::vector<float> one = values({"default", ""});
  EXPECT_EQ(one.size(), 5U * 48U);
  EXPECT_FLOAT_EQ(sum(one), 2);
  const std::vector<float> apart = values({"bins=3,polarity=separate,by_frames=true", ""});
  EXPECT_EQ(apart.size(), 2U * 6U * 48U);
  EXPECT_FLOAT_EQ(sum(apart), 4);
}

TEST_F(ConvertGrids, EventFramesFollowTheFrames) {
  const std::vector<float> frames = values({"", "kind=count,by_frames=true"});
  ASSERT_EQ(frames.size(), 2U * 48U);
  EXPECT_EQ(frames[2 * 8 + 1], 2);
  EXPECT_EQ(frames[48 + 5 * 8 + 7], 1);
  const std::string text =
      convert_to_grids(dataset_, folder_.path() / "pictures", {"", "duration_s=0.02"});
  EXPECT_THAT(text, HasSubstr("pictures: 5 x 2 x 6 x 8 (event_frame, channel, row, column)"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "pictures" / "frame_00000004.png"));
}

TEST_F(ConvertGrids, AnEventFileThatStatesItsSensorWillDo) {
  const std::string text =
      convert_to_grids(dataset_ / "events.h5", folder_.path() / "grids.h5", {"bins=2", ""});
  EXPECT_THAT(text, HasSubstr("1 x 2 x 6 x 8"));
  const auto error = [&](const std::filesystem::path& input, const std::string& output,
                         const GridRequest& request) {
    return error_of([&] { return convert_to_grids(input, folder_.path() / output, request); });
  };
  const std::filesystem::path plain = folder_.write("events.txt", "0.01 1 2 1\n");
  EXPECT_THAT(error(plain, "a.h5", {"default", ""}), HasSubstr("does not state the size"));
  EXPECT_THAT(error(dataset_, "a.h5", {"bin=3", ""}), HasSubstr("did you mean 'bins'?"));
  EXPECT_THAT(error(dataset_, "a.h5", {"bins", ""}), HasSubstr("'bins' must be key=value"));
  EXPECT_THAT(error(dataset_, "a.h5", {"bins=0", ""}), HasSubstr("bins"));
  EXPECT_THAT(error(dataset_, "a.h5", {"events=5,duration_s=1", ""}), HasSubstr("exclude"));
  EXPECT_THAT(error(dataset_, "a", {"bins=1", ""}), HasSubstr("voxel grids are no pictures"));
  EXPECT_THAT(error(dataset_, "a.txt", {"", "default"}), HasSubstr("valid endings of grids"));
  EXPECT_THAT(error(dataset_ / "events.h5", "a.h5", {"", "by_frames=true"}),
              HasSubstr("has no two frames"));
}

}  // namespace
}  // namespace saccade
