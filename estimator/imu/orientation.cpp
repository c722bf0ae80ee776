#include "estimator/imu/orientation.h"

#include <limits>

#include "estimator/imu/inertial_smoother.h"

namespace saccade {
namespace {

void describe_complementary(config::Fields& fields, ComplementaryOptions& options) {
  using Integration = ComplementaryOptions::Integration;
  fields.choice("integration", options.integration,
                {{"end", Integration::kEnd}, {"trapezoid", Integration::kTrapezoid}},
                "Angular velocity between two samples: that of the later one (`end`, as in the "
                "thesis, which lags by half an interval) or the mean of both (`trapezoid`).");
  fields
      .value("time_constant_s", options.time_constant_s,
             "Time constant of the correction by the accelerometer, in seconds; the gain per "
             "sample is 1 - exp(-dt / time_constant_s). Larger values rely longer on the "
             "gyroscope.")
      .above(0);
}

template <class Filter, class BiasOf>
std::vector<ImuOrientation> run(Filter filter, std::span<const ImuSample> samples,
                                const BiasOf& bias_of) {
  std::vector<ImuOrientation> orientations;
  orientations.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    filter.update(sample);
    GyroBiasEstimate estimate = bias_of(filter);
    estimate.t_ns = sample.t_ns;
    Eigen::Quaterniond continuous = filter.world_from_imu();
    if constexpr (requires { filter.continuous(); }) continuous = filter.continuous();
    orientations.push_back({filter.world_from_imu(), continuous, estimate});
  }
  return orientations;
}

}  // namespace

void describe(config::Fields& fields, GyroscopeNoise& noise) {
  fields
      .value("gyro_noise_density", noise.density,
             "Density of the white noise of the angular velocity, in rad/s/sqrt(Hz) (Kalibr's "
             "gyroscope_noise_density). Larger values rely more on the accelerometer and take more "
             "for rest; smaller ones trust the gyroscope longer and miss rests.")
      .range(1e-9, 10);
  fields
      .value("gyro_random_walk", noise.random_walk,
             "Random walk of the bias, in rad/s^2/sqrt(Hz) (Kalibr's gyroscope_random_walk). 0 "
             "keeps the bias constant.")
      .range(0, 10);
}

void describe(config::Fields& fields, OrientationOptions& options) {
  using Method = OrientationOptions::Method;
  fields.choice("method", options.method,
                {{"smoothed", Method::kSmoothed},
                 {"inertial", Method::kInertial},
                 {"complementary", Method::kComplementary},
                 {"gyroscope", Method::kGyroscope}},
                "Filter for the orientation: error-state Kalman filters with velocity, position "
                "and biases that expect fast, usual and gentle motion, run forwards and backwards "
                "in time (`smoothed`, the most accurate) or forwards alone, which knows nothing of "
                "what comes later (`inertial`), the complementary filter of the "
                "thesis (`complementary`, Valenti et al.), or the plain integral of the gyroscope "
                "(`gyroscope`).");
  if (options.method == Method::kInertial || options.method == Method::kSmoothed)
    fields
        .value("position_sigma_m", options.inertial.position_sigma_m,
               "Standard deviation of one component of the position about the start, in metres: "
               "how far a hand carries the sensor. Smaller values give a better tilt as long as "
               "they are true; ~ lets the sensor move anywhere.")
        .range(1e-3, 1000);
  if (options.method == Method::kComplementary)
    describe_complementary(fields, options.complementary);
  if (options.method != Method::kGyroscope) describe(fields, options.gyroscope);
}

std::vector<ImuOrientation> estimate_orientations(std::span<const ImuSample> samples,
                                                  const OrientationOptions& options) {
  if (options.method == OrientationOptions::Method::kSmoothed)
    return smooth_orientations(samples, options.inertial, options.gyroscope);
  if (options.method == OrientationOptions::Method::kInertial)
    return run(
        InertialBank(options.inertial, options.gyroscope), samples, [](const InertialBank& filter) {
          return GyroBiasEstimate{0, filter.bias(), filter.bias_sigma(), filter.is_at_rest()};
        });
  ComplementaryOptions complementary = options.complementary;
  if (options.method == OrientationOptions::Method::kGyroscope) {
    complementary.time_constant_s = std::numeric_limits<double>::infinity();
    complementary.estimate_bias = false;
  }
  return run(ComplementaryFilter(complementary, options.gyroscope), samples,
             [](const ComplementaryFilter& filter) {
               const GyroBiasEstimator& bias = filter.bias();
               return GyroBiasEstimate{0, bias.bias(), bias.sigma(), bias.is_at_rest()};
             });
}

}  // namespace saccade
