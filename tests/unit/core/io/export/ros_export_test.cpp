#include "core/io/export/ros_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/io/dataset/dataset.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/event_formats.h"
#include "core/io/import/ros_messages.h"
#include "core/io/import/ros_recording.h"
#include "core/io/ros/message_file.h"
#include "core/process/progress.h"
#include "core/srgb.h"
#include "tests/support/command.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

class RosExport : public ::testing::Test {
 protected:
  RosExport() {
    set_progress_quiet(true);
    PinholeCamera camera{240, 180, 200, 201, 119, 90, {-0.1, 0.01, 0, 0, 0}};
    DatasetWriterOptions options;
    options.timestamp_unit = TimestampUnit::kNanoseconds;
    DatasetWriter writer(data(), camera, options);
    sort_ties(events_);
    writer.write_events(events_);
    for (std::size_t i = 0; i < 3; ++i) {
      const double t_s = 0.001 + 0.01 * static_cast<double>(i);
      writer.write_frame(i, t_s, ImageF(240, 180, 0.25F));
      ImageF depth(240, 180, 2.0F);
      depth(0, 0) = 0;
      writer.write_depth(i, t_s, depth);
      imu_.push_back({ns_from_seconds(t_s), {0.5, 1, 9.8}, {0.1, 0.2, 0.3}});
      poses_.push_back({t_s, Rigid3(so3_exp({0.1, 0.2, 0.3}), {t_s, 2, 3})});
    }
    writer.write_imu(imu_);
    writer.write_groundtruth(poses_);
    static_cast<void>(writer.finish({}));
  }
  [[nodiscard]] fs::path data() const { return folder_.path() / "data"; }

  testing::TemporaryFolder folder_;
  Events events_ = testing::random_events(100'000);
  std::vector<ImuSample> imu_;
  std::vector<StampedPose> poses_;
};

/// Message by message, how many there are of each topic and whether they are in order of time.
std::map<std::string, int> topics_in(const fs::path& path) {
  std::map<std::string, int> counts;
  const auto file = open_message_file(path);
  while (const auto message = file->next()) ++counts[message->topic->name];
  return counts;
}

TEST_F(RosExport, ComesBackAsTheSameDataset) {
  for (const char* name : {"r.bag", "r.mcap"}) {
    SCOPED_TRACE(name);
    const fs::path file = folder_.path() / name;
    const ImportCounts counts = write_ros_export(data(), file);
    EXPECT_EQ(counts.events, events_.size());
    EXPECT_EQ(counts.frames, 3U);
    EXPECT_EQ(counts.depth_maps, 3U);
    fs::remove_all(folder_.path() / "back");
    EXPECT_EQ(write_ros_recording(file, folder_.path() / "back").text(), counts.text());
    const Dataset before = Dataset::open(data());
    const Dataset back = Dataset::open(folder_.path() / "back");
    EXPECT_EQ(back.load_events(), events_);
    EXPECT_EQ(back.camera(), before.camera());
    ASSERT_EQ(back.frames().size(), 3U);
    EXPECT_EQ(srgb8_from_linear(back.load_frame(2)), srgb8_from_linear(before.load_frame(2)));
    EXPECT_EQ(back.load_depth(1), before.load_depth(1));
    const auto imu = back.load_imu();
    ASSERT_EQ(imu.size(), 3U);
    EXPECT_EQ(imu[1].t_ns, imu_[1].t_ns);
    EXPECT_EQ(imu[1].specific_force, imu_[1].specific_force);
    EXPECT_EQ(imu[1].angular_velocity, imu_[1].angular_velocity);
    ASSERT_EQ(back.groundtruth().size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const StampedPose& pose = back.groundtruth().poses()[i];
      EXPECT_NEAR(pose.t_s, poses_[i].t_s, 1e-9);
      const Rigid3 error = pose.world_from_camera.inverse() * poses_[i].world_from_camera;
      EXPECT_LT(error.log().norm(), 1e-12);
    }
  }
}

TEST_F(RosExport, AnMcapHoldsWhatViewersShow) {
  const fs::path file = folder_.path() / "r.mcap";
  static_cast<void>(write_ros_export(data(), file));
  const auto topics = topics_in(file);
  EXPECT_EQ(topics.at("/view/points"), 3);
  EXPECT_EQ(topics.at("/tf"), 3);
  // A picture for each 1/30 s of the 70 ms.
  EXPECT_EQ(topics.at("/view/events"), 3);
  EXPECT_GE(topics.at("/dvs/events"), 7);
  fs::path bag = folder_.path() / "r.bag";
  static_cast<void>(write_ros_export(data(), bag));
  EXPECT_FALSE(topics_in(bag).contains("/view/events"));
}

TEST_F(RosExport, TheSameDatasetGivesTheSameBytes) {
  for (const char* ending : {".bag", ".mcap"}) {
    static_cast<void>(write_ros_export(data(), folder_.path() / ("a" + std::string(ending))));
    static_cast<void>(write_ros_export(data(), folder_.path() / ("b" + std::string(ending))));
    EXPECT_EQ(testing::read_file(folder_.path() / ("a" + std::string(ending))),
              testing::read_file(folder_.path() / ("b" + std::string(ending))));
  }
}

}  // namespace
}  // namespace saccade
