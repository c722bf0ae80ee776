#include "eval/depth_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/io/images/exr_file.h"
#include "core/io/ply_file.h"
#include "core/io/run/view_list.h"
#include "core/io/trajectory_file.h"
#include "core/rigid3.h"
#include "eval/evaluate.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"
#include "eval/report/report.h"
#include "tests/support/error_of.h"
#include "tests/support/planar_world.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr double kView_s = 0.06;
constexpr float kScale = 1.02F;  ///< of all fake depths

/// A run of `depth` over the corner: every fourth pixel with its true depth, 2 % too large.
class DepthViews : public testing::FakeFolders {
 protected:
  DepthViews() {
    const Rigid3 pose = testing::corner_motion(kView_s);
    const ImageF truth = testing::corner_world(80, 60).depth(pose);
    depth_ = ImageF(80, 60);
    variance_ = ImageF(80, 60);
    for (int y = 4; y < 56; y += 4)
      for (int x = 4; x < 76; x += 4) {
        depth_(x, y) = kScale * truth(x, y);
        variance_(x, y) = 0.01F;
        const Eigen::Vector3d ray = testing::corner_world(80, 60).camera().ray({x, y});
        cloud_.positions.push_back(
            (pose * (static_cast<double>(depth_(x, y)) * ray)).cast<float>());
      }
    fs::create_directories(fake() / "depth");
    const ExrChannel channels[] = {{"Z", depth_}, {"variance", variance_}};
    write_exr(map(), channels);
    write_ply(folder_.path() / "foreign.ply", cloud_);
    RunView view;
    view.t_s = kView_s;
    view.world_from_camera = pose;
    view.depth = map();
    write_view_list(fake() / "views.yaml", std::vector<RunView>{view});
    RunRecord record;
    record.module = "depth";
    record.dataset = dataset();
    write_run_record(fake() / "run.yaml", record);
  }

  [[nodiscard]] fs::path fake() const { return folder_.path() / "fake"; }
  [[nodiscard]] fs::path map() const { return fake() / "depth" / "depth_00000000.exr"; }

  ImageF depth_, variance_;
  PointCloud cloud_;
  TemporaryFolder folder_;
};

void expect_two_percent(const Metrics& metrics, double points) {
  EXPECT_EQ(metrics.get("depth.points"), points);
  EXPECT_NEAR(*metrics.get("depth.strict.rel_median"), 0.02, 0.002);
  EXPECT_LE(*metrics.get("depth.rel_median"), 0.02);
  EXPECT_GT(*metrics.get("depth.completeness"), 0.1);
  EXPECT_LT(*metrics.get("depth.completeness"), 0.9);
}

TEST_F(DepthViews, ARunIsScoredFromItsMaps) {
  const Metrics metrics = evaluate_run(fake());
  expect_two_percent(metrics, static_cast<double>(cloud_.positions.size()));
  EXPECT_EQ(metrics.get("depth.views.count"), 1);
  EXPECT_NEAR(*metrics.get("depth.within_1_sigma"), 1, 0.02) << "2 % of 3 m, sigma 0.1 m";
  EXPECT_TRUE(metrics.get("depth.two_planes.angle_deg"));
  EXPECT_THAT(testing::read_file(fake() / "depth_views.csv"), HasSubstr("strict.rel_median"));
  EXPECT_THAT(format_metrics(metrics, "fake"), HasSubstr("best of 3 x 3"));
}

TEST_F(DepthViews, AWorldOfItsOwnScaleIsAsLargeAsTheTruth) {
  const Dataset data = Dataset::open(dataset());
  std::vector<StampedPose> poses;
  for (const StampedPose& pose : data.groundtruth().poses())
    poses.push_back({pose.t_s, Rigid3(pose.world_from_camera.rotation(),
                                      pose.world_from_camera.translation() / 4)});
  write_tum_trajectory(fake() / "trajectory.txt", poses);
  const double found_m = load_depth_views(fake())[0].points[0].depth_m;
  EXPECT_EQ(load_depth_views(RunFolder::open(fake()), data)[0].points[0].depth_m, found_m);

  folder_.write("fake/start.yaml", "");
  const EstimatedView view = load_depth_views(RunFolder::open(fake()), data)[0];
  EXPECT_NEAR(view.points[0].depth_m, 4 * found_m, 1e-6);
  EXPECT_NEAR(*view.points[0].sigma_m, 0.4, 1e-6);
  EXPECT_NEAR(*evaluate_run(fake()).get("depth.strict.rel_median"), 4 * kScale - 1, 0.01);
}

TEST_F(DepthViews, TheScaleOfAWorldOfItsOwnIsThatOfItsScores) {
  // Positions and orientations tell different scales; their weights depend on the depth of the scene.
  const Dataset data = Dataset::open(dataset());
  std::vector<StampedPose> poses;
  for (const StampedPose& pose : data.groundtruth().poses())
    poses.push_back(
        {pose.t_s, Rigid3(so3_exp({0, 0, 0.5 + 0.5 * pose.t_s}) * pose.world_from_camera.rotation(),
                          pose.world_from_camera.translation())});
  write_tum_trajectory(fake() / "trajectory.txt", poses);
  const double found_m = load_depth_views(fake())[0].points[0].depth_m;
  folder_.write("fake/start.yaml", "");
  const RunFolder run = RunFolder::open(fake());
  std::vector<double> scales;
  for (const double mean_depth_m : {0.001, 1000.0}) {
    TrajectoryScoreInput input = score_input(run, data);
    input.mean_depth_m = mean_depth_m;
    scales.push_back(truth_from_estimate(input).scale);
    EXPECT_NEAR(load_depth_views(run, data, mean_depth_m)[0].points[0].depth_m,
                scales.back() * found_m, 1e-9);
    EvaluateOptions options;
    options.mean_depth_m = mean_depth_m;
    EXPECT_NEAR(*evaluate_run(fake(), options).get("depth.strict.rel_median"),
                std::abs(scales.back() * kScale - 1), 0.01);
  }
  EXPECT_GT(std::abs(scales[1] / scales[0] - 1), 0.05) << "the test needs two scales";
}

TEST_F(DepthViews, TheCloudOfARunHasTheExactPositions) {
  cloud_.scalars = {{"view", {}}, {"x_px", {}}, {"y_px", {}}, {"depth_m", {}}, {"sigma_m", {}}};
  cloud_.positions.resize(1);
  const float values[] = {0, 40.25F, 30.5F, 2.5F, 0.1F};
  for (std::size_t i = 0; i < 5; ++i) cloud_.scalars[i].values = {values[i]};
  write_ply(fake() / "cloud.ply", cloud_);
  const auto views = load_depth_views(fake());
  ASSERT_EQ(views.size(), 1U);
  ASSERT_EQ(views[0].points.size(), 1U) << "the maps are not read beside it";
  EXPECT_EQ(views[0].points[0].pixel, Eigen::Vector2d(40.25, 30.5));
  EXPECT_EQ(views[0].points[0].depth_m, 2.5);

  cloud_.scalars[0].values = {3};
  write_ply(fake() / "cloud.ply", cloud_);
  EXPECT_THAT(error_of([&] { return load_depth_views(fake()); }), HasSubstr("there are 1 views"));
}

TEST_F(DepthViews, OtherProgramsResultsScoreAlike) {
  const auto points = static_cast<double>(cloud_.positions.size());
  expect_two_percent(evaluate_depth({map(), false, kView_s}, dataset()), points);
  expect_two_percent(evaluate_depth({fake(), false, {}}, dataset()), points);
  expect_two_percent(evaluate_depth({folder_.path() / "foreign.ply", true, kView_s}, dataset()),
                     points);
}

TEST_F(DepthViews, SaysWhatIsWrong) {
  const auto error = [&](const ExternalDepth& depth) {
    return error_of([&] { return evaluate_depth(depth, dataset()); });
  };
  EXPECT_THAT(error({folder_.path(), false, {}}), HasSubstr("views.yaml"));
  EXPECT_THAT(error({folder_.path() / "none.exr", false, kView_s}), HasSubstr("none.exr"));
  EXPECT_THAT(error({map(), false, 77.0}), HasSubstr("77"));
  EXPECT_THAT(error({map(), true, kView_s}), HasSubstr("depth_00000000.exr"));
}

TEST_F(DepthViews, WithoutTruthPointsAreCountedOnly) {
  const TemporaryFolder blind;
  fs::copy(dataset(), blind.path() / "data", fs::copy_options::recursive);
  fs::remove(blind.path() / "data" / "depth.txt");
  EvaluateOptions options;
  options.dataset = blind.path() / "data";
  const Metrics metrics = evaluate_run(fake(), options);
  EXPECT_EQ(metrics.get("depth.points"), static_cast<double>(cloud_.positions.size()));
  EXPECT_EQ(metrics.get("depth.rel_mean"), std::nullopt);
}

TEST_F(DepthViews, AppearInTheReport) {
  write_report(std::vector<fs::path>{fake()}, folder_.path() / "report.html");
  const std::string page = testing::read_file(folder_.path() / "report.html");
  for (const char* part : {"id=\"depth\"", "relative error of the depth",
                           "orientation by the true poses", "cloud from above", "to 1 [deg]"})
    EXPECT_THAT(page, HasSubstr(part));
}

}  // namespace
}  // namespace saccade
