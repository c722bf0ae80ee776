#include "estimator/reconstruction/observations/reprojector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/depth_mesh.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;
using testing::PlanarWorld;

/// The corner as one view of it.
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

TEST(Reprojector, FindsTheObservedPoint) {
  const Corner corner;
  const PinholeCamera& camera = corner.world.camera();
  Reprojector reprojector(camera, corner.scene, corner_motion(0), corner.reference, {});
  const auto pose_at = [&](double t_s) {
    const Rigid3 pose = corner_motion(0).inverse() * corner_motion(t_s);
    return CameraPose{pose.rotation_matrix().cast<float>(), pose.translation().cast<float>()};
  };
  // The surfaces are rendered at one time and read at another, within the allowed motion.
  reprojector.prepare(pose_at(0.09));
  const auto surfaces = reprojector.prepare(pose_at(0.102));
  EXPECT_EQ(reprojector.draws(), 1);
  const ImageF depth = corner.world.depth(corner_motion(0.102));
  int found = 0, good = 0;
  for (int y = 5; y < 85; ++y)
    for (int x = 5; x < 115; ++x) {
      const auto z = static_cast<double>(depth(x, y));
      const auto reprojection = reprojector.find(x, y, *surfaces, pose_at(0.102));
      if (!(z > 0) || !reprojection) continue;
      const Eigen::Vector3d point =
          corner_motion(0).inverse() * (corner_motion(0.102) * (z * camera.ray({x, y})));
      const Eigen::Vector2d expected = camera.project(point);
      ++found;
      good +=
          std::hypot(reprojection->x - expected.x(), reprojection->y - expected.y()) < 0.02 ? 1 : 0;
    }
  EXPECT_GT(found, 7000);
  EXPECT_GT(good, 0.97 * found);
}

TEST(Reprojector, AnEarlierReprojectionIsAFirstGuessOnly) {
  const Corner corner;
  const PinholeCamera& camera = corner.world.camera();
  Reprojector reprojector(camera, corner.scene, corner_motion(0), corner.reference, {});
  const Rigid3 motion = corner_motion(0).inverse() * corner_motion(0.05);
  const CameraPose pose{motion.rotation_matrix().cast<float>(), motion.translation().cast<float>()};
  const auto surfaces = reprojector.prepare(pose);
  int found = 0, good = 0;
  for (int y = 5; y < 85; ++y)
    for (int x = 5; x < 115; ++x) {
      const auto reprojection = reprojector.find(x, y, *surfaces, pose);
      if (!reprojection) continue;
      const Eigen::Vector2f off(std::min(reprojection->x + 4, 119.0F),
                                std::max(reprojection->y - 3, 0.0F));
      const auto again = reprojector.find(x, y, *surfaces, pose, &off);
      ASSERT_TRUE(again.has_value()) << x << " " << y;
      ++found;
      good += std::hypot(reprojection->x - again->x, reprojection->y - again->y) < 0.02F ? 1 : 0;
    }
  EXPECT_GT(found, 7000);
  EXPECT_GT(good, 0.97 * found);
}

TEST(Reprojector, RendersAnewAfterParallaxBetweenSurfaces) {
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
    Reprojector reprojector(camera, scene, Rigid3(), reference,
                            {.redraw_motion_px = 8, .redraw_parallax_px = 1});
    reprojector.prepare({Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero()});
    reprojector.prepare(pose);
    return reprojector.draws();
  };
  // 4 px at 1 m; a surface at 2 m stays 2 px behind, one at 1.2 m by 0.7 px.
  const CameraPose aside{Eigen::Matrix3f::Identity(), {0.1F, 0, 0}};
  EXPECT_EQ(draws_after(2, aside), 2);
  EXPECT_EQ(draws_after(1.2, aside), 1);
  const CameraPose turned{Eigen::AngleAxisf(0.1F, Eigen::Vector3f::UnitY()).matrix(),
                          Eigen::Vector3f::Zero()};
  EXPECT_EQ(draws_after(2, turned), 1);
}

TEST(Reprojector, FindsNothingNearADepthDiscontinuity) {
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
    Reprojector reprojector(camera, scene, Rigid3(), reference,
                            {.discontinuity_margin_px = margin});
    const auto surfaces = reprojector.prepare(at_reference);
    for (int x = 0; x < 40; ++x) {
      const bool is_near = x >= 20 - margin && x < 20 + margin;
      EXPECT_EQ(reprojector.find(x, 15, *surfaces, at_reference).has_value(), !is_near)
          << margin << " " << x;
    }
  }
}

}  // namespace
}  // namespace saccade
