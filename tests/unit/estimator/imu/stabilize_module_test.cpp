#include "estimator/imu/stabilize_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/event_file.h"
#include "core/io/events/events_h5.h"
#include "core/io/events/stabilized_events.h"
#include "core/io/files/file_list.h"
#include "core/io/run/run_record.h"
#include "core/process/parallel.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_folder.h"
#include "tests/support/source_path.h"
#include "tests/unit/estimator/imu/turning_dataset.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_file;

constexpr double kDuration_s = 0.25;

class StabilizeModule : public testing::SharedFolder<StabilizeModule> {
 public:
  static void fill() { testing::write_turning_dataset(path("corner"), kDuration_s, 120); }

 protected:
  [[nodiscard]] static RunRequest request(const std::string& name,
                                          const std::string& yaml = "window: {duration_s: 0.05}") {
    return testing::run_request(path("corner"), path(name), yaml);
  }
};

TEST_F(StabilizeModule, FindsTheOrientation) {
  run_stabilization(request("orientation"));
  const Trajectory found = read_orientations(path("orientation") / "orientation.txt");
  EXPECT_EQ(found.size(), 251U);
  const Eigen::Quaterniond first = found.poses()[0].world_from_camera.rotation() *
                                   testing::corner_motion(0).rotation().conjugate();
  for (const StampedPose& pose : found.poses())
    EXPECT_LT(angle_between(pose.world_from_camera.rotation(),
                            first * testing::corner_motion(pose.t_s).rotation()),
              1e-3);
  EXPECT_EQ(read_gyro_biases(path("orientation") / "gyro_bias.txt").size(), 251U);
}

TEST_F(StabilizeModule, PutsEventsWhereTheSteadyCameraWouldSeeThem) {
  run_stabilization(request("events"));
  const fs::path folder = path("events") / "stabilized";
  const auto windows = read_stabilized_windows(folder / "windows.csv");
  EXPECT_EQ(windows.size(), 5U);
  const Events events = read_events(folder / "events.h5", {120, 90});
  ASSERT_GT(events.size(), 1000U);
  const StabilizedCoordinates places =
      read_stabilized_coordinates(folder / "places.h5", events.size());
  const PinholeCamera camera = Dataset::open(path("corner")).camera();
  std::size_t window = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const double t_s = seconds_from_ns(events[i].t_ns);
    while (t_s >= windows[window].end_s) ++window;
    const Eigen::Quaterniond turn =
        windows[window].steady_from_camera *
        testing::corner_motion(windows[window].at_s).rotation().conjugate() *
        testing::corner_motion(t_s).rotation();
    const Eigen::Vector2d source(places.source_x[i], places.source_y[i]);
    const Eigen::Vector2d expected = camera.project(turn * camera.ray(source));
    EXPECT_NEAR(places.x[i], expected.x(), 0.1);
    EXPECT_NEAR(places.y[i], expected.y(), 0.1);
    EXPECT_NEAR(places.x[i], events[i].x, 0.501);
    EXPECT_NEAR(places.y[i], events[i].y, 0.501);
  }
}

TEST_F(StabilizeModule, StabilizesFrames) {
  run_stabilization(request("frames"));
  const auto files = read_file_list(path("frames") / "stabilized" / "images.txt");
  EXPECT_EQ(files.size(), Dataset::open(path("corner")).frames().size());
  for (const StampedFile& file : files) EXPECT_TRUE(fs::exists(file.file));
}

TEST_F(StabilizeModule, TheSameForAnyNumberOfThreads) {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    run_stabilization(request("threads" + std::to_string(threads)));
  }
  set_thread_count(2);
  for (const char* file : {"orientation.txt", "stabilized/events.h5", "stabilized/places.h5",
                           "stabilized/windows.csv"})
    EXPECT_EQ(read_file(path("threads1") / file), read_file(path("threads2") / file)) << file;
}

TEST_F(StabilizeModule, TakesThePosesOfAnotherProgram) {
  auto with_poses = request("poses");
  with_poses.poses_from = path("corner") / "groundtruth.txt";
  run_stabilization(with_poses);
  EXPECT_TRUE(fs::exists(path("poses") / "stabilized" / "events.h5"));
  EXPECT_FALSE(fs::exists(path("poses") / "gyro_bias.txt"));
}

TEST_F(StabilizeModule, ALengthAloneCountsFromTheFirstEvent) {
  fs::copy(path("corner"), path("late"), fs::copy_options::recursive);
  const Dataset data = Dataset::open(path("late"));
  Events events = data.load_events(0.1);
  const double first_s = seconds_from_ns(events.front().t_ns);
  EventH5Writer writer(path("late") / "events.h5", TimestampUnit::kNanoseconds);
  writer.append(events);
  writer.close();
  auto shorter = request("shorter");
  shorter.dataset = path("late");
  shorter.duration_s = 0.08;
  run_stabilization(shorter);
  const RunRecord record = read_run_record(path("shorter") / "run.yaml");
  EXPECT_NEAR(record.window->start_s, first_s, 1e-6);
  EXPECT_NEAR(record.window->end_s, first_s + 0.08, 1e-6);
}

TEST_F(StabilizeModule, WithoutASensorItSaysWhatIsMissing) {
  testing::write_corner_dataset(path("no_imu"), "corner", 0.05, 80);
  auto without = request("x");
  without.dataset = path("no_imu");
  EXPECT_THAT(error_of([&] { return run_stabilization(without).found; }),
              HasSubstr("holds no imu.txt"));
}

TEST(StabilizeConfig, ShippedFilesAreRead) {
  const std::string folder = testing::source_path("configs/stabilization/");
  const auto method = [&](const char* name) {
    return config::read<StabilizeConfig>(config::load(folder + name)).orientation.method;
  };
  EXPECT_EQ(method("best.yaml"), OrientationOptions::Method::kSmoothed);
  EXPECT_EQ(method("thesis.yaml"), OrientationOptions::Method::kComplementary);
  EXPECT_EQ(method("gyroscope.yaml"), OrientationOptions::Method::kGyroscope);
}

}  // namespace
}  // namespace saccade
