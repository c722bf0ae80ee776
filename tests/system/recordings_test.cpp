// Whole recordings and poses through the command.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/dataset/dataset.h"
#include "core/io/trajectory_file.h"
#include "tests/support/shared_data.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(Recordings, AnAedat4BecomesADatasetAndARecordingOfRos) {
  SACCADE_SHARED_DATA_OR_SKIP(recording, "formats/evl_sample.aedat4");
  const TemporaryFolder folder;
  const std::string data = (folder.path() / "data").string();
  EXPECT_THAT(saccade_ok({"convert", recording.string(), data}),
              HasSubstr("6676 events, 4 frames, "));
  EXPECT_THAT(saccade_ok({"info", data}), HasSubstr("6,676"));
  for (const char* name : {"r.mcap", "r.bag"}) {
    const std::string file = (folder.path() / name).string();
    saccade_ok({"convert", data, file});
    const std::string back =
        (folder.path() / fs::path(name).extension().string().substr(1)).string();
    saccade_ok({"convert", file, back});
    const Dataset before = Dataset::open(data);
    const Dataset after = Dataset::open(back);
    EXPECT_EQ(after.load_events(), before.load_events());
    ASSERT_EQ(after.frames().size(), 4U);
    EXPECT_EQ(after.load_frame(3), before.load_frame(3));
    EXPECT_EQ(after.load_imu().size(), before.load_imu().size());
  }
}

TEST(Recordings, PosesGoToOtherPrograms) {
  const TemporaryFolder folder;
  const std::string data = (folder.path() / "data").string();
  saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o", data, "--set",
              "duration_s=0.1", "--set",
              "camera={width: 64, height: 48, fx: 50, fy: 50, cx: 31.5, cy: 23.5}"});
  EXPECT_THAT(saccade_ok({"convert", data, data + "/transforms.json"}), HasSubstr(" poses"));
  const std::string run = (folder.path() / "run").string();
  saccade_ok({"run", "track", "--data", data, "-c", shipped_config("tracking/fast.yaml"), "-o", run,
              "--threads", "1"});
  saccade_ok({"convert", run, (folder.path() / "evaluation").string()});
  EXPECT_EQ(read_tum_trajectory(folder.path() / "evaluation/stamped_traj_estimate.txt").size(),
            read_tum_trajectory(fs::path(run) / "trajectory.txt").size());
  EXPECT_GT(read_tum_trajectory(folder.path() / "evaluation/stamped_groundtruth.txt").size(), 10U);
  const fs::path images = folder.write("images.txt", "1 1 0 0 0 0 0 0 1 frame_00000000.png\n\n");
  saccade_ok({"convert", images.string(), (folder.path() / "poses.txt").string(), "--data", data});
  EXPECT_EQ(read_tum_trajectory(folder.path() / "poses.txt").size(), 1U);
  const CommandResult result = run_command(
      SACCADE_COMMAND, {"convert", images.string(), (folder.path() / "poses.txt").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("COLMAP's pictures have no times"));
}

TEST(Recordings, DamagedOnesEndWithTheirPlaceAndCode2) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("r.mcap", std::string("\x89MCAP0\r\n\x06", 9));
  const CommandResult result =
      run_command(SACCADE_COMMAND, {"convert", file.string(), (folder.path() / "d").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("r.mcap:byte 8: the file ends within the head of a record"));
  EXPECT_FALSE(fs::exists(folder.path() / "d"));
}

}  // namespace
}  // namespace saccade::testing
