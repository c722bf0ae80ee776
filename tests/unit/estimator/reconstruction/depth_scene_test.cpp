#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>

#include "core/depth_mesh.h"
#include "estimator/reconstruction/depth_splat.h"
#include "estimator/reconstruction/place_finder.h"
#include "estimator/reconstruction/place_levels.h"
#include "estimator/reconstruction/point_surface.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;
using testing::PlanarWorld;

TEST(DepthSplat, NearPointsHideFarOnes) {
  const PinholeCamera camera{40, 30, 40, 40, 19.5, 14.5, {}};
  std::vector<Eigen::Vector3f> points;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const Eigen::Vector3f ray = camera.ray({x, y}).cast<float>();
      points.push_back(3.0F * ray);
      if (x >= 20) points.push_back(1.0F * ray);
    }
  ImageF inverse(40, 30);
  DepthSplat(points, 7).draw(Rigid3(), camera, inverse);
  EXPECT_NEAR(inverse(30, 15), 1, 1e-4);
  EXPECT_NEAR(inverse(5, 15), 1 / 3.0, 1e-4);
}

TEST(DepthSplat, LargerKernelsReachFarther) {
  const PinholeCamera camera{60, 60, 40, 40, 29.5, 29.5, {}};
  const std::vector<Eigen::Vector3f> point = {2.0F * camera.ray({30, 30}).cast<float>()};
  for (const int size : {3, 7, 15, 25}) {
    ImageF inverse(60, 60);
    DepthSplat(point, size).draw(Rigid3(), camera, inverse);
    int known = 0;
    for (const float value : inverse.pixels()) known += value > 0 ? 1 : 0;
    EXPECT_EQ(known, size * size);
  }
}

/// What a view of the corner knows of it.
struct Corner {
  PlanarWorld world = corner_world(120, 90);
  DepthMesh mesh{world.depth(corner_motion(0)), world.camera()};
  DepthScene scene;
  ImageF reference{120, 90};  ///< inverse depth [1/m]

  Corner() {
    scene.typical_depth_m = mesh.typical_depth_m();
    scene.draw = [this](const Rigid3& camera_from_world, const PinholeCamera& target,
                        ImageF& inverse) {
      mesh.draw(camera_from_world * corner_motion(0), target, inverse);
    };
    scene.draw(corner_motion(0).inverse(), world.camera(), reference);
  }
  Corner(const Corner&) = delete;
  Corner& operator=(const Corner&) = delete;
};

TEST(PlaceFinder, FindsWhereAPixelLooks) {
  const Corner corner;
  const PinholeCamera& camera = corner.world.camera();
  PlaceFinder finder(camera, corner.scene, corner_motion(0), corner.reference, {});
  const auto pose_at = [&](double t_s) {
    const Rigid3 pose = corner_motion(0).inverse() * corner_motion(t_s);
    return CameraPose{pose.rotation_matrix().cast<float>(), pose.translation().cast<float>()};
  };
  // The surfaces are drawn for one moment and read at another, within the motion that is allowed.
  finder.prepare(pose_at(0.09));
  finder.prepare(pose_at(0.102));
  EXPECT_EQ(finder.draws(), 1);
  const ImageF depth = corner.world.depth(corner_motion(0.102));
  int found = 0, good = 0;
  for (int y = 5; y < 85; ++y)
    for (int x = 5; x < 115; ++x) {
      const auto z = static_cast<double>(depth(x, y));
      const auto place = finder.find(x, y, pose_at(0.102));
      if (!(z > 0) || !place) continue;
      const Eigen::Vector3d point =
          corner_motion(0).inverse() * (corner_motion(0.102) * (z * camera.ray({x, y})));
      const Eigen::Vector2d expected = camera.project(point);
      ++found;
      good += std::hypot(place->x - expected.x(), place->y - expected.y()) < 0.02 ? 1 : 0;
    }
  EXPECT_GT(found, 7000);
  EXPECT_GT(good, 0.97 * found);
}

TEST(PlaceFinder, AnEarlierPlaceIsAFirstGuessOnly) {
  const Corner corner;
  const PinholeCamera& camera = corner.world.camera();
  PlaceFinder finder(camera, corner.scene, corner_motion(0), corner.reference, {});
  const Rigid3 motion = corner_motion(0).inverse() * corner_motion(0.05);
  const CameraPose pose{motion.rotation_matrix().cast<float>(), motion.translation().cast<float>()};
  finder.prepare(pose);
  int found = 0, good = 0;
  for (int y = 5; y < 85; ++y)
    for (int x = 5; x < 115; ++x) {
      const auto place = finder.find(x, y, pose);
      if (!place) continue;
      const Eigen::Vector2f off(std::min(place->x + 4, 119.0F), std::max(place->y - 3, 0.0F));
      const auto again = finder.find(x, y, pose, &off);
      ASSERT_TRUE(again.has_value()) << x << " " << y;
      ++found;
      good += std::hypot(place->x - again->x, place->y - again->y) < 0.02F ? 1 : 0;
    }
  EXPECT_GT(found, 7000);
  EXPECT_GT(good, 0.97 * found);
}

TEST(PlaceFinder, DrawsAnewWhereSurfacesShiftAgainstEachOther) {
  const PinholeCamera camera{40, 30, 40, 40, 19.5, 14.5, {}};
  const auto draws_after = [&](double far, const CameraPose& pose) {
    DepthScene scene;
    scene.draw = [far](const Rigid3&, const PinholeCamera& target, ImageF& inverse) {
      for (int y = 0; y < inverse.height(); ++y)
        for (int x = 0; x < inverse.width(); ++x)
          inverse(x, y) = x < target.cx ? 1.0F : static_cast<float>(1 / far);
    };
    ImageF reference(40, 30);
    scene.draw(Rigid3(), camera, reference);
    PlaceFinder finder(camera, scene, Rigid3(), reference, {.redraw_px = 8, .parallax_px = 1});
    finder.prepare({Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero()});
    finder.prepare(pose);
    return finder.draws();
  };
  // 4 px at 1 m; a surface at 2 m stays 2 px behind, one at 1.2 m by 0.7 px.
  const CameraPose aside{Eigen::Matrix3f::Identity(), {0.1F, 0, 0}};
  EXPECT_EQ(draws_after(2, aside), 2);
  EXPECT_EQ(draws_after(1.2, aside), 1);
  const CameraPose turned{Eigen::AngleAxisf(0.1F, Eigen::Vector3f::UnitY()).matrix(),
                          Eigen::Vector3f::Zero()};
  EXPECT_EQ(draws_after(2, turned), 1);
}

TEST(PlaceFinder, FindsNothingNextToAStepOfDepth) {
  const PinholeCamera camera{40, 30, 40, 40, 19.5, 14.5, {}};
  DepthScene scene;
  scene.draw = [](const Rigid3&, const PinholeCamera& target, ImageF& inverse) {
    for (int y = 0; y < inverse.height(); ++y)
      for (int x = 0; x < inverse.width(); ++x) inverse(x, y) = x < target.cx ? 1.0F : 0.5F;
  };
  ImageF reference(40, 30);
  scene.draw(Rigid3(), camera, reference);
  const CameraPose at_reference{Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero()};
  for (const int margin : {0, 1, 3}) {
    PlaceFinder finder(camera, scene, Rigid3(), reference, {.step_margin_px = margin});
    finder.prepare(at_reference);
    for (int x = 0; x < 40; ++x) {
      const bool is_near = x >= 20 - margin && x < 20 + margin;
      EXPECT_EQ(finder.find(x, 15, at_reference).has_value(), !is_near) << margin << " " << x;
    }
  }
}

TEST(SurfaceLevels, AsksEverySilentPixelInItsTurn) {
  const PinholeCamera camera{24, 18, 20, 20, 11.5, 8.5, {}};
  DepthScene scene;
  scene.draw = [](const Rigid3&, const PinholeCamera&, ImageF& inverse) { inverse.fill(1); };
  const ImageF reference(24, 18, 1);
  // 4 px of motion along x in 0.1 s, and one event at each end.
  const Trajectory motion(
      {{0, Rigid3()}, {0.1, Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.2, 0, 0))}});
  Events events;
  for (int i = 0; i <= 4096; ++i) events.push_back({i * 100'000'000LL / 4096, 0, 0, 1});
  for (const int turns : {1, 3}) {
    LevelOptions options;
    options.still_px = 0.5;
    options.places.redraw_px = 1;
    options.still_turns = turns;
    SurfaceLevels finder(camera, scene, Rigid3(), reference, 0.2, 0.2, options);
    std::vector<PlaceLevel> levels;
    finder.find(events, motion, levels);
    std::set<std::uint32_t> tracks;
    int silent = 0;
    for (const PlaceLevel& level : levels) {
      const float slack = finder.sorts()[level.sort()].slack;
      if (slack == 0) continue;
      tracks.insert(level.track());
      ++silent;
      EXPECT_FLOAT_EQ(slack, 0.2F);
    }
    // 8 looks at each of the 20 to 24 columns of 18 pixels that stay in the view, give or take one.
    EXPECT_NEAR(silent * turns, 22 * 18 * 8, 22 * 18 * 8 / 5) << turns;
    EXPECT_GE(tracks.size(), 20U * 18U) << turns;
  }
}

/// Sees points at `depth` on the pixels from `first` to `last`, every `step` of them.
template <class Depth>
void append_points(std::vector<SurfacePoint>& points, const PinholeCamera& camera,
                   Eigen::Vector2i first, Eigen::Vector2i last, int step, const Depth& depth) {
  for (int y = first.y(); y <= last.y(); y += step)
    for (int x = first.x(); x <= last.x(); x += step)
      points.push_back({depth(x, y) * camera.ray({x, y}), 0.005});
}

const PinholeCamera kSurfaceCamera{96, 72, 80, 80, 47.5, 35.5, {}};

TEST(PointSurface, NearSurfacesEndWhereTheirPointsDo) {
  const PinholeCamera& camera = kSurfaceCamera;
  std::vector<SurfacePoint> points;
  append_points(points, camera, {30, 20}, {60, 50}, 3, [](int, int) { return 1.0; });
  append_points(points, camera, {0, 0}, {18, 71}, 3, [](int, int) { return 3.0; });
  append_points(points, camera, {75, 0}, {95, 71}, 3, [](int, int) { return 3.0; });
  const ImageF depth = surface_through(points, camera, {});
  EXPECT_NEAR(depth(45, 35), 1, 0.01);
  EXPECT_NEAR(depth(31, 48), 1, 0.01);
  for (const int x : {5, 22, 27, 64, 70, 90}) EXPECT_NEAR(depth(x, 35), 3, 0.03) << x;
  for (const int y : {5, 15, 55, 66}) EXPECT_NEAR(depth(45, y), 3, 0.03) << y;
}

// Offers that differ in nothing from what is there leave the moves without a pair to cut.
TEST(PointSurface, PointsOfOnePlaneGiveThePlane) {
  std::vector<SurfacePoint> points;
  for (int y = 4; y < kSurfaceCamera.height; y += 8)
    for (int x = 4; x < kSurfaceCamera.width; x += 8)
      points.push_back({2.0 * kSurfaceCamera.ray({x, y}), 0.002});
  const ImageF depth = surface_through(points, kSurfaceCamera, {});
  for (const float z : depth.pixels()) EXPECT_NEAR(z, 2, 0.01);
}

TEST(PointSurface, IgnoresHiddenPointsAndOutliers) {
  const PinholeCamera& camera = kSurfaceCamera;
  std::vector<SurfacePoint> points;
  append_points(points, camera, {0, 0}, {95, 71}, 3, [](int, int) { return 1.0; });
  append_points(points, camera, {31, 31}, {61, 61}, 6, [](int, int) { return 2.5; });
  points[100].position *= 0.7;
  const ImageF depth = surface_through(points, camera, {});
  int wrong = 0;
  for (const float z : depth.pixels()) wrong += std::abs(z - 1) > 0.01F ? 1 : 0;
  EXPECT_LE(wrong, 1);
}

TEST(PointSurface, SlantedPlanesMeetAtTheirCrease) {
  const PinholeCamera& camera = kSurfaceCamera;
  // 1 / z of two planes that meet at column 40.
  const auto depth_of = [](int x, int) { return 1 / (0.5 + 0.004 * std::abs(x - 40)); };
  std::vector<SurfacePoint> points;
  append_points(points, camera, {2, 2}, {94, 70}, 2, depth_of);
  const ImageF depth = surface_through(points, camera, {});
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x) {
      const double error = std::abs(static_cast<double>(depth(x, y)) / depth_of(x, y) - 1);
      EXPECT_LT(error, std::abs(x - 40) < 4 ? 0.03 : 0.005) << x << " " << y;
    }
}

TEST(PointSurface, WithoutPointsNothingIsKnown) {
  const ImageF depth = surface_through({}, kSurfaceCamera, {});
  for (const float z : depth.pixels()) EXPECT_EQ(z, 0);
}

}  // namespace
}  // namespace saccade
