#include "estimator/tracking/gyroscope_input.h"

#include "estimator/imu/imu_input.h"

namespace saccade {

Gyroscope load_gyroscope(const PredictionOptions& options, const Dataset& dataset) {
  if (options.prediction != PredictionOptions::Prediction::kImu) return {};
  const ImuInput imu = load_imu_input(dataset, "motion.prediction: imu");
  return {imu.samples, imu.camera_from_imu, options.gyro_bias};
}

}  // namespace saccade
