#include "estimator/mosaic/mosaic_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/io/images/exr_file.h"
#include "core/io/images/panorama_file.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "estimator/registry.h"
#include "tests/support/command.h"
#include "tests/support/direction_world.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_folder.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_file;

class MosaicModule : public testing::SharedFolder<MosaicModule> {
 public:
  static void fill() { testing::write_sky_dataset(dataset(), testing::sweep(0.4, 1.5), 1.0); }

 protected:
  [[nodiscard]] static fs::path dataset() { return path("sky"); }
  [[nodiscard]] static RunRequest request(const std::string& name, const std::string& yaml) {
    return testing::run_request(dataset(), path(name), yaml);
  }
};

TEST_F(MosaicModule, NeedsNothingButEventsAndTheInertialSensor) {
  const fs::path bare = path("bare");
  fs::copy(dataset(), bare);
  fs::remove(bare / "groundtruth.txt");
  fs::remove(bare / "panorama.exr");
  RunRequest blind = request("blind", "snapshot_events: [3000, 1000000]");
  blind.dataset = bare;
  const RunSummary summary = run_mosaic(blind);
  EXPECT_GT(summary.events, 1000U);
  for (const char* file : {"mosaic.exr", "mosaic.png", "orientation.txt", "gyro_bias.txt",
                           "growth/growth_000003000.png", "run.yaml", "timing.json"})
    EXPECT_TRUE(fs::exists(path("blind") / file)) << file;
  const Panorama panorama = read_panorama(path("blind") / "mosaic.yaml");
  const auto channels = read_exr_channels(path("blind") / "mosaic.exr");
  ASSERT_EQ(channels.size(), 2U);
  EXPECT_EQ(channels[0].name, "L");
  EXPECT_EQ(channels[1].name, "observed");
  EXPECT_EQ(channels[0].image.width(), panorama.width);
}

TEST_F(MosaicModule, IsTheSameForAnyNumberOfThreads) {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    (void)run_mosaic(request("t" + std::to_string(threads), "snapshot_events: [2000, 5000]"));
  }
  set_thread_count(0);
  for (const char* file : {"mosaic.exr", "mosaic.png", "mosaic.yaml", "orientation.txt",
                           "growth/growth_000002000.png"})
    EXPECT_EQ(read_file(path("t1") / file), read_file(path("t2") / file)) << file;
}

TEST_F(MosaicModule, TakesTheOrientationOfAnotherRun) {
  (void)run_module("mosaic", request("by_imu", ""));
  RunRequest run = request("by_run", "");
  run.poses_from = path("by_imu");
  (void)run_module("mosaic", run);
  EXPECT_EQ(read_file(path("by_run") / "mosaic.exr"), read_file(path("by_imu") / "mosaic.exr"));
  EXPECT_FALSE(fs::exists(path("by_run") / "gyro_bias.txt"));
  (void)run_module("stabilize", request("steady", ""));
  RunRequest steady = request("by_steady", "");
  steady.poses_from = path("steady");
  (void)run_module("mosaic", steady);
  EXPECT_TRUE(fs::exists(path("by_steady") / "mosaic.exr"));
  RunRequest truth = request("by_truth", "method: gradient");
  truth.poses_from = dataset() / "groundtruth.txt";
  (void)run_module("mosaic", truth);
  EXPECT_TRUE(fs::exists(path("by_truth") / "mosaic.exr"));
}

TEST_F(MosaicModule, MayShowTheWholeSphere) {
  (void)run_mosaic(request("sphere", "{extent: sphere, panorama_px_per_rad: 20}"));
  const Panorama panorama = read_panorama(path("sphere") / "mosaic.yaml");
  EXPECT_EQ(panorama, Panorama::sphere(panorama.around));
  EXPECT_GE(panorama.pixels_per_radian(), 20);
  EXPECT_LT(panorama.pixels_per_radian(), 30);
}

TEST_F(MosaicModule, NamesWhatIsMissing) {
  const fs::path without_imu = path("without_imu");
  fs::copy(dataset(), without_imu);
  fs::remove(without_imu / "imu.txt");
  RunRequest run = request("none", "");
  run.dataset = without_imu;
  EXPECT_THAT(error_of([&] { return run_mosaic(run); }),
              ::testing::AllOf(HasSubstr("imu.txt"), HasSubstr("--poses-from")));
  EXPECT_FALSE(fs::exists(path("none")));
  run = request("none", "");
  const std::vector<StampedPose> late = {{50, {}}, {51, {}}};
  write_tum_trajectory(path("late.txt"), late);
  run.poses_from = path("late.txt");
  EXPECT_THAT(error_of([&] { return run_mosaic(run); }), HasSubstr("no events within the time"));
  EXPECT_THAT(error_of([&] { return run_mosaic(request("none", "panorama_px_per_rad: 0")); }),
              HasSubstr("panorama_px_per_rad"));
  EXPECT_THAT(error_of([&] { return run_mosaic(request("none", "snapshot_events: [5000, 0]")); }),
              HasSubstr("snapshot_events"));
  EXPECT_THAT(error_of([&] { return run_mosaic(request("none", "depth: {}")); }),
              HasSubstr("depth"));
}

}  // namespace
}  // namespace saccade
