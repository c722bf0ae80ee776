#include "estimator/run/camera_correction.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(CameraCorrection, ScalesTheFocalLengthsAlone) {
  PinholeCamera camera;
  camera.width = 240;
  camera.height = 180;
  camera.fx = 200;
  camera.fy = 210;
  camera.cx = 119.5;
  camera.cy = 89.5;
  camera.distortion = {-0.3, 0.1, 0, 0, 0};
  EXPECT_EQ(CameraCorrection{}.of(camera), camera);
  PinholeCamera expected = camera;
  expected.fx = 202;
  expected.fy = 212.1;
  EXPECT_EQ(CameraCorrection{1.01}.of(camera), expected);
}

}  // namespace
}  // namespace saccade
