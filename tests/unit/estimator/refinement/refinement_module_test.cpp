#include "estimator/refinement/refinement_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "core/config/document.h"
#include "core/io/covariance_file.h"
#include "core/io/run/run_record.h"
#include "core/io/run/view_list.h"
#include "core/io/tables/csv_reader.h"
#include "core/io/trajectory_file.h"
#include "core/srgb.h"
#include "estimator/odometry/odometry_module.h"
#include "estimator/registry.h"
#include "estimator/tracking/track_module.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/planar_world.h"
#include "tests/support/recording.h"
#include "tests/support/shared_folder.h"
#include "tests/support/source_path.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::PlanarWorld;
using testing::read_file;

constexpr double kWall_m = 1.5;
constexpr double kRunEnd_s = 0.4;

/// One textured wall at kWall_m that fills the view of a small camera.
PlanarWorld wall() { return testing::wall_world(120, 90, 100, kWall_m, 240, 180); }

Rigid3 sweep(double t_s) {
  return {so3_exp({0.05 * t_s, -0.1 * t_s, 0.2 * t_s}),
          {0.9 * t_s, 0.1 * std::sin(8 * t_s), 0.1 * t_s}};
}

/// Sideways with a turn, before a corner.
Rigid3 wavy_glide(double t_s) {
  return {so3_exp({0.1 * t_s, -0.25 * t_s, 0.3 * t_s}),
          {0.8 * t_s, 0.1 * std::sin(6 * t_s), 0.1 * t_s}};
}

void record(const fs::path& folder, const PlanarWorld& world, const testing::Motion& motion,
            double end_s) {
  ImageF radiance = world.log_intensity(motion(0));
  for (float& value : radiance.pixels()) value = std::exp(value) - 1e-3F;
  const testing::StampedPicture picture{0, srgb8_from_linear(radiance)};
  std::vector<StampedPose> poses;
  for (int i = 0; i * 1e-3 <= end_s + 1e-9; ++i) poses.push_back({i * 1e-3, motion(i * 1e-3)});
  testing::write_recording(folder, world.camera(), world.simulate(motion, 0, end_s, 1e-3, 0.12),
                           std::span(&picture, 1), poses);
}

struct Errors {
  double position_m = 0, rotation_rad = 0;
};

/// Root mean squares over a run's poses.
Errors errors_of(const fs::path& run, const testing::Motion& motion) {
  const Trajectory found = read_trajectory(run / "trajectory.txt");
  Errors errors;
  for (const StampedPose& pose : found.poses()) {
    const Rigid3 error = motion(pose.t_s).inverse() * pose.world_from_camera;
    const auto count = static_cast<double>(found.size());
    errors.position_m += error.translation().squaredNorm() / count;
    errors.rotation_rad += so3_log(error.rotation()).squaredNorm() / count;
  }
  return {std::sqrt(errors.position_m), std::sqrt(errors.rotation_rad)};
}

class RefinementModule : public testing::SharedFolder<RefinementModule> {
 public:
  static void fill() {
    record(dataset(), wall(), sweep, kRunEnd_s);
    RunRequest track = request("track", "reference: {frame: 0, planar_depth_m: 1.5}");
    track.from.reset();
    (void)run_track(track);
  }

 protected:
  static fs::path dataset() { return path("wall"); }

  static RunRequest request(const std::string& name, const std::string& yaml) {
    RunRequest request = testing::run_request(dataset(), path(name), yaml);
    request.from = path("track");
    return request;
  }
};

constexpr const char* kPoses =
    "{method: poses, poses: {contrast_on: 0.12, contrast_off: 0.12, events: 20000}}";

TEST_F(RefinementModule, PosesOfATrackedRunBecomeBetter) {
  const RunSummary summary = run_refinement(request("poses", kPoses));
  EXPECT_GT(summary.poses, 10U);
  const Errors before = errors_of(path("track"), sweep), after = errors_of(path("poses"), sweep);
  EXPECT_LT(after.position_m, 0.5 * before.position_m);
  EXPECT_LT(after.rotation_rad, 0.5 * before.rotation_rad);
  for (const char* name : {"trajectory.txt", "poses.csv", "map.ply", "covariance.txt", "cost.csv",
                           "run.yaml", "timing.json"})
    EXPECT_TRUE(fs::is_regular_file(path("poses") / name)) << name;
  const RunRecord record = read_run_record(path("poses") / "run.yaml");
  EXPECT_EQ(record.module, "refine");
  EXPECT_EQ(record.from, path("track"));
  EXPECT_THAT(record.config_yaml, HasSubstr("method: poses"));
  EXPECT_EQ(read_covariances(path("poses") / "covariance.txt").size(), summary.poses);
  const CsvColumns costs(path("poses") / "cost.csv");
  EXPECT_GT(costs.rows(), 2U);
  EXPECT_GE(costs.number(costs.rows() - 1, costs.require("seconds")), 0);
}

TEST_F(RefinementModule, PosesByImagesOfEventsBecomeBetter) {
  (void)run_refinement(request("images",
                               "{method: poses, poses: {contrast_on: 0.12, contrast_off: 0.12, "
                               "residual: frames, rounds: 1}}"));
  const Errors before = errors_of(path("track"), sweep), after = errors_of(path("images"), sweep);
  EXPECT_LT(after.position_m, before.position_m);
  EXPECT_LT(after.rotation_rad, before.rotation_rad);
}

TEST_F(RefinementModule, PathAndMapOfARunOfOdometryGoTogether) {
  record(path("corner"), testing::corner_world(160, 120), wavy_glide, 0.5);
  RunRequest odometry = request("odometry", R"(
start: {truth_s: 0.2, truth_fraction: 0.4}
keyframe: {distance: 0.05, active: 3}
mapping: {duration_s: 0.3, min_edges: 0, image: false}
adjustment: {rounds: 0}
tracking: {event_map_ratio: 0.2}
)");
  odometry.dataset = path("corner");
  odometry.from.reset();
  (void)run_odometry(odometry);
  RunRequest joint = request(
      "joint", "{method: joint, joint: {window: {duration_s: 0.5}, edges: 200, rounds: 1}}");
  joint.dataset = path("corner");
  joint.from = path("odometry");
  (void)run_refinement(joint);
  const Errors before = errors_of(path("odometry"), wavy_glide),
               after = errors_of(path("joint"), wavy_glide);
  EXPECT_LT(after.position_m, before.position_m);
  const auto views = read_view_list(path("joint") / "views.yaml");
  EXPECT_EQ(views.size(), read_view_list(path("odometry") / "views.yaml").size());
  for (const RunView& view : views) EXPECT_TRUE(fs::is_regular_file(view.depth));
  for (const char* name :
       {"trajectory.txt", "poses.csv", "map.ply", "covariance.txt", "cost.csv", "keyframes.yaml"})
    EXPECT_TRUE(fs::is_regular_file(path("joint") / name)) << name;
}

TEST_F(RefinementModule, SaysWhatIsWrongWithTheRun) {
  const auto error = [&](const std::optional<fs::path>& from, const std::string& yaml = kPoses) {
    RunRequest refine = request("failed", yaml);
    refine.from = from;
    const std::string message = error_of([&] { return run_refinement(refine); });
    EXPECT_FALSE(fs::exists(path("failed")));
    return message;
  };
  EXPECT_THAT(error(std::nullopt), HasSubstr("--from"));
  EXPECT_THAT(error(path("absent")), HasSubstr("absent"));
  EXPECT_THAT(error(path("track"), "{}"), HasSubstr("poses.contrast_on"));
  EXPECT_THAT(error(path("track"), "{method: joint}"), HasSubstr("track"));
  const fs::path broken = path("broken");
  fs::copy(path("track"), broken);
  fs::remove(broken / "poses.csv");
  EXPECT_THAT(error(broken), HasSubstr("poses.csv"));
  fs::copy(path("track") / "poses.csv", broken);
  std::ofstream(broken / "trajectory.txt") << "0 1 2\n";
  EXPECT_THAT(error(broken), HasSubstr("trajectory.txt:1"));
  std::string record = read_file(path("track") / "run.yaml");
  const std::size_t at = record.find("sha256: ") + 8;
  record[at + 1] = record[at + 1] == '0' ? '1' : '0';
  std::ofstream(broken / "run.yaml") << record;
  EXPECT_THAT(error(broken), HasSubstr("written anew since"));
  record.replace(record.find(dataset().string()), dataset().string().size(), "/elsewhere");
  std::ofstream(broken / "run.yaml") << record;
  EXPECT_THAT(error(broken), HasSubstr("a run over /elsewhere, which is not the dataset"));
}

TEST_F(RefinementModule, OtherModulesRefineNothing) {
  RunRequest track = request("failed", "{}");
  EXPECT_THAT(error_of([&] { return run_module("track", track); }), HasSubstr("--from"));
}

TEST(RefinementConfigs, ShippedOnesAreRead) {
  for (const char* name : {"poses", "depth", "joint"})
    EXPECT_THAT(find_module("refine").print_config(
                    config::load(testing::source_path("configs/refinement/") + name + ".yaml")),
                HasSubstr(std::string("method: ") + name));
  EXPECT_THAT(find_module("refine").print_config(
                  config::load(testing::source_path("configs/refinement/poses_frames.yaml"))),
              HasSubstr("residual: frames"));
}

}  // namespace
}  // namespace saccade
