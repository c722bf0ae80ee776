#include "estimator/tracking/gyroscope_input.h"

#include "estimator/imu/imu_input.h"

namespace saccade {

Gyroscope load_gyroscope(const MotionModelOptions& options, const Dataset& dataset) {
  if (options.prediction != MotionModelOptions::Prediction::kImu) return {};
  ImuInput imu = load_imu_input(dataset, "motion.prediction: imu");
  for (ImuSample& sample : imu.samples) sample.t_ns += ns_from_seconds(options.gyro_offset_s);
  return {imu.samples, imu.camera_from_imu, options.gyro_bias};
}

}  // namespace saccade
