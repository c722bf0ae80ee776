#include "simulator/preview.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/config/config.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

class Preview : public testing::MeshFiles {
 protected:
  /// A camera that passes a white square of 1 m, 2 m before it, with f = 32 px and 0.5 m/s.
  ScenePreview seen() const {
    write("square.obj", testing::square_obj());
    return preview(config::read<SimulationConfig>(config::parse(
                       "scene:\n"
                       "  meshes:\n"
                       "    - {file: square.obj, transform: {translation: [-0.5, -0.5, 2]}}\n"
                       "  background: 0.1\n"
                       "trajectory: {source: slider, from: [-0.25, 0, 0], direction: [1, 0, 0],\n"
                       "             distance_m: 0.5, duration_s: 1}\n"
                       "camera: {width: 64, height: 48, fx: 32, fy: 32}\n"
                       "events: {contrast_on: 0.2, contrast_off: 0.1}\n",
                       "preview.yaml", folder_)),
                   3, 40);
  }
};

TEST_F(Preview, ViewsAreAtEvenTimesFromTheFirstToTheLast) {
  const ScenePreview preview = seen();
  ASSERT_EQ(preview.views.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const double t_s = 0.5 * static_cast<double>(i);
    EXPECT_NEAR(preview.views[i].pose.t_s, t_s, 1e-9);
    EXPECT_NEAR(preview.views[i].pose.world_from_camera.translation().x(), -0.25 + 0.5 * t_s, 1e-6);
  }
}

TEST_F(Preview, StatesDepthAndImageMotion) {
  const PreviewView view = seen().views[1];
  EXPECT_NEAR(view.nearest_m, 2, 1e-5);
  EXPECT_NEAR(view.median_m, 2, 1e-5);
  // Most of the picture is background, infinitely far.
  EXPECT_NEAR(view.flow_px_per_s, 0, 1e-9);
}

/// The left and the right side of the square, 16 px high, move at f v / z = 8 px/s and change the log
/// intensity by `step`. Central differences give the pixel on either side of an edge half of it; one
/// of both is background, which does not move.
TEST_F(Preview, EstimatesTheRateOfEventsFromGradientAndMotion) {
  const ScenePreview preview = seen();
  const PreviewView& view = preview.views[1];
  const double inside = static_cast<double>(view.radiance(32, 24));
  const double step = std::abs(std::log((inside + 1e-3) / (0.1 + 1e-3)));
  const double one_side = 16 * 8 * 0.5 * step;
  EXPECT_NEAR(view.events_per_s, one_side / 0.2 + one_side / 0.1,
              0.02 * (one_side / 0.2 + one_side / 0.1));
}

TEST_F(Preview, ThePlanLooksDownOntoThePath) {
  const ScenePreview preview = seen();
  EXPECT_EQ(preview.plan.radiance.width(), 40);
  EXPECT_NEAR(preview.plan.centre_m.x(), 0, 1e-6);
  EXPECT_NEAR(preview.plan.centre_m.y(), 0, 1e-6);
  // Half of the path and the median depth to either side.
  EXPECT_NEAR(preview.plan.px_per_m, 40 / 4.5, 1e-3);
  // The square is above the path, and cut off.
  for (const float value : preview.plan.radiance.pixels()) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace saccade
