#include "estimator/refinement/poses/pose_refinement.h"

#include <gtest/gtest.h>

#include "tests/unit/estimator/refinement/poses/corner_view.h"

namespace saccade {
namespace {

using testing::corner_view;
using testing::CornerView;

using Residual = PoseRefinementOptions::Residual;

RefinedPath refined_path(double share, int rounds = 3, Residual residual = Residual::kEvents) {
  const CornerView& r = corner_view();
  const MapSurface surface(r.map);
  std::vector<StampedPose> start = r.disturbed(share);
  for (StampedPose& pose : start)
    pose.world_from_camera = r.map.world_from_map().inverse() * pose.world_from_camera;
  PoseRefinementOptions options;
  options.residual = residual;
  options.events = 20000;
  options.window_events = 5000;
  options.increments = 100000;
  options.rounds = rounds;
  return refine_path(surface, r.world.camera(), {CornerView::kContrast, CornerView::kContrast},
                     r.events, start, options);
}

/// Root mean squares over time of the errors of position [m] and orientation [rad].
std::pair<double, double> errors_of(const Spline& map_from_camera) {
  std::pair<double, double> squares{0, 0};
  double count = 0;
  for (double t_s = 0.01; t_s < CornerView::kEnd_s - 0.005; t_s += 0.005, ++count) {
    const Rigid3 pose = corner_view().map.world_from_map() * map_from_camera.pose(t_s);
    const Rigid3 error = CornerView::motion(t_s).inverse() * pose;
    squares.first += error.translation().squaredNorm();
    squares.second += so3_log(error.rotation()).squaredNorm();
  }
  return {std::sqrt(squares.first / count), std::sqrt(squares.second / count)};
}

TEST(PoseRefinement, BringsADisturbedPathBack) {
  const auto [before_m, before_rad] = errors_of(refined_path(1, 0).map_from_camera.spline());
  const RefinedPath path = refined_path(1);
  const auto [after_m, after_rad] = errors_of(path.map_from_camera.spline());
  EXPECT_LT(after_m, 0.2 * before_m);
  EXPECT_LT(after_rad, 0.3 * before_rad);
  EXPECT_GT(path.inliers, path.observations * 9 / 10);
  ASSERT_EQ(path.costs.rounds(), 3);
  EXPECT_LT(path.costs.steps().back().cost, 0.5 * path.costs.steps().front().cost);
}

TEST(PoseRefinement, BringsADisturbedPathBackByImages) {
  const auto [before_m, before_rad] = errors_of(refined_path(1, 0).map_from_camera.spline());
  const RefinedPath path = refined_path(1, 1, Residual::kFrames);
  const auto [after_m, after_rad] = errors_of(path.map_from_camera.spline());
  EXPECT_LT(after_m, 0.3 * before_m);
  EXPECT_LT(after_rad, 0.4 * before_rad);
  EXPECT_GT(path.inliers, path.observations * 9 / 10);
  EXPECT_LT(path.costs.steps().back().cost, path.costs.steps().front().cost);
  const double variance = path.covariance_at(0.15).topLeftCorner<3, 3>().trace();
  EXPECT_GT(variance, 1e-12);
  EXPECT_LT(variance, 1e-4);
}

TEST(PoseRefinement, KnowsHowSureItIs) {
  const RefinedPath path = refined_path(0, 1);
  const Matrix6 covariance = path.covariance_at(0.15);
  const double position_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  const double rotation_rad = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
  EXPECT_GT(position_m, 1e-5);
  EXPECT_LT(position_m, 0.01);
  EXPECT_GT(rotation_rad, 1e-5);
  EXPECT_LT(rotation_rad, 0.01);
}

TEST(PoseRefinement, IsTheSameEveryTime) {
  const RefinedPath a = refined_path(1, 1), b = refined_path(1, 1);
  for (std::size_t k = 0; k < a.map_from_camera.poses.size(); ++k) {
    EXPECT_EQ(a.map_from_camera.poses[k].translation(), b.map_from_camera.poses[k].translation());
    EXPECT_EQ(a.map_from_camera.poses[k].rotation().coeffs(),
              b.map_from_camera.poses[k].rotation().coeffs());
  }
  EXPECT_EQ(a.covariances, b.covariances);
}

TEST(PoseRefinement, WithoutEventsThePathStays) {
  const CornerView& r = corner_view();
  const MapSurface surface(r.map);
  const auto start = r.disturbed(1);
  for (const Residual residual : {Residual::kEvents, Residual::kFrames}) {
    PoseRefinementOptions options;
    options.residual = residual;
    const auto path = refine_path(surface, r.world.camera(), {0.1, 0.1}, {}, start, options);
    EXPECT_EQ(path.observations, 0U);
    const auto kept = SplineControls::smooth(start, options.knot_spacing_s);
    for (std::size_t k = 0; k < kept.poses.size(); ++k)
      EXPECT_LT((kept.poses[k].inverse() * path.map_from_camera.poses[k]).log().norm(), 1e-9);
  }
}

}  // namespace
}  // namespace saccade
