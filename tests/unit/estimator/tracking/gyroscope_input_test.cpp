#include "estimator/tracking/motion_model.h"

#include <gtest/gtest.h>

#include "core/io/imu_file.h"
#include "tests/support/command.h"
#include "tests/support/recording.h"

namespace saccade {
namespace {

TEST(GyroscopeInput, ReadingsAreOfALaterTimeThanTheirStamps) {
  const testing::TemporaryFolder folder;
  PinholeCamera camera;
  camera.width = camera.height = 8;
  camera.fx = camera.fy = 8;
  camera.cx = camera.cy = 3.5;
  const testing::StampedPicture blank{0, ImageU8(8, 8)};
  const StampedPose still;
  testing::write_recording(folder.path(), camera, {}, std::span(&blank, 1), std::span(&still, 1));
  std::vector<ImuSample> samples;
  for (int i = 0; i <= 100; ++i) {
    ImuSample sample;
    sample.t_ns = 1'000'000 * i;
    sample.angular_velocity = {0.01 * i, 0, 0};
    samples.push_back(sample);
  }
  write_imu(folder.path() / "imu.txt", samples);
  const Dataset dataset = Dataset::open(folder.path());
  MotionModelOptions options;
  EXPECT_TRUE(load_gyroscope(options, dataset).is_empty()) << "of prediction: imu alone";
  options.prediction = MotionModelOptions::Prediction::kImu;
  const auto rate = [&] {
    return load_gyroscope(options, dataset).mean_rate(50'000'000, 50'000'000).x();
  };
  EXPECT_NEAR(rate(), 0.5, 1e-9);
  options.time_offset_s = 0.005;
  EXPECT_NEAR(rate(), 0.45, 1e-9);
}

}  // namespace
}  // namespace saccade
