#include "estimator/imu/orientation.h"

#include <limits>

namespace saccade {
namespace {

void describe_rest(config::Fields& fields, RestOptions& options) {
  fields.value("window_s", options.window_s, "readings are judged by their mean over this time")
      .range(1e-3, 100);
  fields.value("accel", options.accel, "at rest below this difference from gravity [m/s^2]")
      .range(1e-6, 100);
  fields.value("rate", options.rate, "and below this rate, while the bias is unknown [rad/s]")
      .range(1e-6, 100);
  fields.value("rate_change", options.rate_change, "and change from window to window [rad/s]")
      .range(1e-6, 100);
}

void describe_accelerometer(config::Fields& fields, AccelerometerNoise& noise) {
  fields.value("density", noise.density, "of the white noise [m/s^2/sqrt(Hz)]").range(1e-9, 100);
  fields.value("random_walk", noise.random_walk, "of the bias [m/s^3/sqrt(Hz)]").range(0, 100);
  fields.value("bias_sigma", noise.bias_sigma, "deviation of the bias at the start [m/s^2]")
      .range(1e-9, 100);
}

void describe_gap(config::Fields& fields, double& max_gap_s) {
  fields.value("max_gap_s", max_gap_s, "after a longer gap the tilt is read again")
      .range(1e-4, 100);
}

void describe_gravity(config::Fields& fields, double& gravity) {
  fields.value("gravity", gravity, "[m/s^2]").range(0.1, 100);
}

void describe_inertial(config::Fields& fields, InertialOptions& options) {
  describe_gravity(fields, options.gravity);
  fields.value("speed", options.speed, "deviation of a component of the velocity [m/s]")
      .range(1e-3, 1000);
  fields.value("speed_time_s", options.speed_time_s, "after which the velocity is another one")
      .range(1e-3, 1000);
  fields.value("reach", options.reach, "deviation of a component of the position [m]; ~ for none")
      .range(1e-3, 1000);
  fields.value("reach_time_s", options.reach_time_s, "after which the position is another one")
      .range(1e-3, 1000);
  fields.value("tilt_sigma", options.tilt_sigma, "deviation of the tilt read from one force [rad]")
      .range(1e-4, 3);
  describe_gap(fields, options.max_gap_s);
  fields
      .value("readings_per_update", options.readings_per_update,
             "the covariance follows the state in steps of so many readings")
      .range(1, 1000);
  fields.group(
      "gyroscope", [&](config::Fields& f) { describe(f, options.gyroscope); }, "its noise");
  fields.group(
      "accelerometer", [&](config::Fields& f) { describe_accelerometer(f, options.accelerometer); },
      "its noise");
  fields.group(
      "rest", [&](config::Fields& f) { describe_rest(f, options.rest); },
      "when the sensor does not move");
}

void describe_bias(config::Fields& fields, SteadyBiasOptions& options) {
  fields.value("estimate", options.estimate, "the bias is read at rest (3.17)");
  fields.value("gain", options.gain, "alpha_bias per window; ~ follows from the variances")
      .range(0, 1);
  fields.group(
      "rest", [&](config::Fields& f) { describe_rest(f, options.rest); },
      "when the sensor does not move");
  fields.group(
      "gyroscope", [&](config::Fields& f) { describe(f, options.noise); }, "its noise");
}

void describe_complementary(config::Fields& fields, ComplementaryOptions& options) {
  using Integration = ComplementaryOptions::Integration;
  describe_gravity(fields, options.gravity);
  fields.choice("integration", options.integration,
                {{"end", Integration::kEnd}, {"trapezoid", Integration::kTrapezoid}},
                "rate between two readings: that of the later one, or the mean of both");
  fields
      .value("time_constant_s", options.time_constant_s,
             "of the correction by gravity: alpha = 1 - exp(-dt / time constant)")
      .above(0);
  fields.value("adaptive", options.adaptive, "less correction under acceleration");
  fields
      .value("full_trust", options.full_trust,
             "relative difference of the force from gravity up to which all of it")
      .range(0, 10);
  fields.value("no_trust", options.no_trust, "and from which on none of it").range(0, 10);
  fields.expect(options.full_trust < options.no_trust, "full_trust", "must be below no_trust");
  fields
      .value("slerp_below", options.slerp_below,
             "first component of the correction below which slerp stands in for lerp")
      .range(-1, 1);
  describe_gap(fields, options.max_gap_s);
  fields.group(
      "bias", [&](config::Fields& f) { describe_bias(f, options.bias); }, "of the gyroscope");
}

template <class Filter, class Gyro>
std::vector<ImuOrientation> run(Filter filter, std::span<const ImuSample> samples,
                                const Gyro& gyro) {
  std::vector<ImuOrientation> orientations;
  orientations.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    filter.update(sample);
    GyroBiasEstimate estimate = gyro(filter);
    estimate.t_ns = sample.t_ns;
    orientations.push_back({filter.world_from_imu(), estimate});
  }
  return orientations;
}

std::vector<ImuOrientation> run_complementary(std::span<const ImuSample> samples,
                                              const ComplementaryOptions& options) {
  return run(ComplementaryFilter(options), samples, [](const ComplementaryFilter& filter) {
    const SteadyBias& bias = filter.bias();
    return GyroBiasEstimate{0, bias.bias(), bias.sigma(), bias.is_steady()};
  });
}

}  // namespace

void describe(config::Fields& fields, GyroscopeNoise& noise) {
  fields.value("density", noise.density, "of the white noise [rad/s/sqrt(Hz)]").range(1e-9, 10);
  fields.value("random_walk", noise.random_walk, "of the bias [rad/s^2/sqrt(Hz)]").range(0, 10);
  fields.value("bias_sigma", noise.bias_sigma, "deviation of the bias at the start [rad/s]")
      .range(1e-9, 10);
}

void describe(config::Fields& fields, OrientationOptions& options) {
  using Method = OrientationOptions::Method;
  fields.choice("method", options.method,
                {{"inertial", Method::kInertial},
                 {"complementary", Method::kComplementary},
                 {"gyroscope", Method::kGyroscope}},
                "how orientation is found");
  if (options.method == Method::kInertial)
    fields.group(
        "inertial", [&](config::Fields& f) { describe_inertial(f, options.inertial); },
        "error-state Kalman filter with velocity and biases");
  if (options.method == Method::kComplementary)
    fields.group(
        "complementary",
        [&](config::Fields& f) { describe_complementary(f, options.complementary); },
        "the thesis's filter (3.1)");
}

std::vector<ImuOrientation> estimate_orientations(std::span<const ImuSample> samples,
                                                  const OrientationOptions& options) {
  switch (options.method) {
    case OrientationOptions::Method::kInertial:
      return run(InertialFilter(options.inertial), samples, [](const InertialFilter& filter) {
        return GyroBiasEstimate{0, filter.bias(), filter.bias_sigma(), filter.is_at_rest()};
      });
    case OrientationOptions::Method::kComplementary:
      return run_complementary(samples, options.complementary);
    case OrientationOptions::Method::kGyroscope: {
      ComplementaryOptions integral = options.complementary;
      integral.time_constant_s = std::numeric_limits<double>::infinity();
      integral.bias.estimate = false;
      return run_complementary(samples, integral);
    }
  }
  return {};
}

}  // namespace saccade
