#include "eval/information/information.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/io/dataset/dataset_writer.h"
#include "eval/information/observations.h"
#include "eval/information/true_edges.h"
#include "tests/support/command.h"
#include "tests/support/jacobian_check.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::Motion;
using testing::TemporaryFolder;

/// Frames, depth and poses of the corner world over half a second.
Dataset recording(const TemporaryFolder& folder, const std::string& name, const Motion& motion,
                  double contrast) {
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  DatasetWriter writer(folder.path() / name, world.camera());
  for (std::size_t i = 0; i <= 10; ++i) {
    const double t_s = 0.05 * static_cast<double>(i);
    ImageF radiance = world.log_intensity(motion(t_s));
    for (float& value : radiance.pixels()) value = std::exp(value);
    writer.write_frame(i, t_s, radiance);
    writer.write_depth(i, t_s, world.depth(motion(t_s)));
  }
  const Trajectory path = testing::trajectory_of(motion, 0.5);
  writer.write_groundtruth({path.poses().begin(), path.poses().end()});
  DatasetRecord record;
  record.name = name;
  record.duration_s = 0.5;
  record.contrast_on = record.contrast_off = contrast;
  record.mean_scene_depth_m = testing::kCornerDepth_m;
  (void)writer.finish(record);
  return Dataset::open(folder.path() / name);
}

Rigid3 slide(double t_s) {
  return Rigid3::exp((Twist() << 1.2 * t_s, 0.2 * t_s, 0, 0, 0, 0).finished());
}
Rigid3 turn(double t_s) {
  return Rigid3::exp((Twist() << 0, 0, 0, 0, 0.5 * t_s, 0.2 * t_s).finished());
}
Rigid3 tremble(double t_s) {
  return Rigid3::exp((Twist() << 0.001 * t_s, 0, 0, 0, 0, 0).finished());
}

TEST(Information, ASlideTellsPathAndDepth) {
  const TemporaryFolder folder;
  const auto found = information_of(recording(folder, "slide", slide, 0.15));
  ASSERT_TRUE(found);
  EXPECT_LT(found->pose_percent, 0.05);
  EXPECT_LT(found->pose_deg, 0.05);
  EXPECT_LT(found->path_percent, 0.5);
  EXPECT_GT(found->depth_share, 0.5);
  EXPECT_GE(found->path_percent, found->pose_percent) << "a map that is known cannot hurt";
  EXPECT_GT(found->own_path_percent, 0);
  EXPECT_LT(found->own_path_percent, 0.5);
  for (const char* module : {"track", "odometry", "depth", "reconstruct"})
    EXPECT_TRUE(found->is_enough_for(module)) << module;
}

TEST(Information, ATurnAloneTellsNoDepth) {
  const TemporaryFolder folder;
  const auto found = information_of(recording(folder, "turn", turn, 0.15));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->depth_share, 0);
  EXPECT_FALSE(found->is_enough_for("depth"));
  EXPECT_TRUE(found->is_enough_for("track"));
}

TEST(Information, FewerEdgesFireWithHigherThresholds) {
  const TemporaryFolder folder;
  const auto low = information_of(recording(folder, "low", slide, 0.1));
  const auto high = information_of(recording(folder, "high", slide, 1.2));
  const auto none = information_of(recording(folder, "none", slide, 20));
  ASSERT_TRUE(low && high && none);
  EXPECT_LT(low->pose_percent, high->pose_percent);
  EXPECT_LT(low->path_percent, high->path_percent);
  EXPECT_EQ(none->pose_percent, 100);
  EXPECT_FALSE(none->is_enough_for("track"));
}

TEST(Information, HardlyAnyMotionLeavesDepthAndScaleOpen) {
  const TemporaryFolder folder;
  const auto found = information_of(recording(folder, "still", tremble, 0.15));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->depth_share, 0);
  EXPECT_LT(found->pose_percent, 2) << "a pose that is held is off by no more than it moves";
}

TEST(Information, WithoutDepthNothingIsKnown) {
  const TemporaryFolder folder;
  DatasetWriter writer(folder.path() / "poses", testing::corner_world(160, 120).camera());
  const Trajectory path = testing::trajectory_of(slide, 0.5);
  writer.write_groundtruth({path.poses().begin(), path.poses().end()});
  (void)writer.finish({});
  EXPECT_FALSE(information_of(Dataset::open(folder.path() / "poses")));
}

TrueEdge some_edge() {
  TrueEdge edge;
  edge.point = {0.3, -0.2, 2.1};
  edge.along = edge.point + Eigen::Vector3d(0.006, 0.009, 0);
  edge.per_log_z = edge.point;
  edge.per_px = {0.009, -0.006, 0};
  edge.strength = 0.4;
  return edge;
}

TEST(LineObservation, HasTheDerivativesOfThePlaceAcrossTheLine) {
  const PinholeCamera camera = testing::corner_world(160, 120).camera();
  const TrueEdge edge = some_edge();
  const Rigid3 pose = Rigid3::exp((Twist() << 0.1, -0.05, 0.2, 0.03, -0.1, 0.2).finished());
  const LineObservation observation = linearise(camera, edge, pose);
  const Rigid3 camera_from_world = pose.inverse();
  const Eigen::Vector2d line = (camera.project(camera_from_world * edge.along) -
                                camera.project(camera_from_world * edge.point))
                                   .normalized();
  const Eigen::RowVector2d normal(-line.y(), line.x());
  const auto place = [&](const Rigid3& at, const Eigen::Vector3d& point) {
    return Eigen::Matrix<double, 1, 1>(normal * camera.project(at.inverse() * point));
  };
  testing::expect_jacobian<1, 6>(
      observation.by_pose,
      [&](const Twist& xi) { return place(pose * Rigid3::exp(xi), edge.point); }, Twist::Zero());
  testing::expect_jacobian<1, 2>(
      observation.by_edge,
      [&](const Eigen::Vector2d& x) {
        return place(pose, edge.point + edge.per_log_z * x[0] + edge.per_px * x[1]);
      },
      Eigen::Vector2d::Zero());
}

TEST(Observe, EventsOfAStrongEdgeSayBetterWhereItIs) {
  const TemporaryFolder folder;
  const Dataset dataset = recording(folder, "slide", slide, 0.15);
  const TrueEdges edges = find_true_edges(dataset, 0.075);
  const auto nodes = path_nodes(dataset.groundtruth(), edges, dataset.camera(), 2);
  // 0.15 log units are a way of 1.5 px over the faint edge, and of 0.15 px over the strong one.
  for (const auto& [strength, sigma_px] : {std::pair{0.1, 1.5 / std::sqrt(12)}, {1.0, 0.1}}) {
    TrueEdge edge = edges.edges[edges.edges.size() / 2];
    edge.strength = strength;
    const auto observations = observe(dataset.camera(), edges, edge, nodes, 0.15);
    ASSERT_FALSE(observations.empty());
    // It says so anew for each two pixels that it moves by.
    for (const LineObservation& observation : observations) {
      EXPECT_GE(observation.weight, (1 - 1e-9) / (sigma_px * sigma_px));
      EXPECT_LE(observation.weight, 2 / (sigma_px * sigma_px));
    }
  }
}

TEST(TrueEdges, AreNotSeenBehindWhatIsInFront) {
  const TemporaryFolder folder;
  const Dataset dataset = recording(folder, "slide", slide, 0.15);
  const TrueEdges edges = find_true_edges(dataset, 0.075);
  ASSERT_EQ(edges.frames.size(), 11U);
  ASSERT_GT(edges.edges.size(), 1000U);
  const TrueEdge& edge = edges.edges[edges.edges.size() / 2];
  using Sight = TrueEdges::Sight;
  const PinholeCamera& camera = dataset.camera();
  EXPECT_EQ(edges.sight(camera, edge.frame, edge.point), Sight::kSeen);
  EXPECT_EQ(edges.sight(camera, edge.frame, edge.point + edge.per_log_z), Sight::kHidden);
  EXPECT_EQ(edges.sight(camera, edge.frame, edge.point - 2 * edge.per_log_z), Sight::kOutside);
}

}  // namespace
}  // namespace saccade
