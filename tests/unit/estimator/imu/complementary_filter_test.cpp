#include "estimator/imu/complementary_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "core/rigid3.h"
#include "estimator/imu/tilt.h"
#include "tests/unit/estimator/imu/upright.h"

namespace saccade {
namespace {

using testing::kDegree;
using testing::kUp;

Eigen::Vector3d normal3(std::uint64_t seed, std::uint64_t index) {
  const Random random(seed);
  return {random.normal(0, index), random.normal(1, index), random.normal(2, index)};
}

/// What a sensor without errors reads that turns in place.
template <class Orientation>
std::vector<ImuSample> readings(const Orientation& world_from_imu, double duration_s,
                                double step_s = 1e-3) {
  std::vector<ImuSample> samples;
  const auto count = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i <= count; ++i) {
    const double t_s = i * step_s;
    constexpr double kDelta_s = 1e-5;
    const Eigen::Quaterniond here = world_from_imu(t_s);
    ImuSample sample;
    sample.t_ns = ns_from_seconds(t_s);
    sample.specific_force = here.conjugate() * kUp;
    sample.angular_velocity =
        so3_log(world_from_imu(t_s - kDelta_s).conjugate() * world_from_imu(t_s + kDelta_s)) /
        (2 * kDelta_s);
    samples.push_back(sample);
  }
  return samples;
}

Eigen::Quaterniond shaken(double t_s) {
  return so3_exp({0.3 * std::sin(8 * t_s), 0.4 * std::sin(11 * t_s + 1), 0.2 * std::sin(5 * t_s)}) *
         so3_exp({1.2, 0.1, -0.4});
}

/// Between the up directions as two orientations have them [rad].
double tilt_error(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d in_a = a.conjugate() * up, in_b = b.conjugate() * up;
  return std::atan2(in_a.cross(in_b).norm(), in_a.dot(in_b));
}

TEST(TiltCorrection, TakesTheVerticalToAnyDirection) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Vector3d g = normal3(1, i).normalized();
    const Eigen::Quaterniond dq = tilt_correction(g);
    EXPECT_LT((dq * Eigen::Vector3d::UnitZ() - g).norm(), 1e-12);
    EXPECT_EQ(dq.z(), 0) << "turns about the vertical";
  }
  const Eigen::Quaterniond half = tilt_correction({0, 0, -1});
  EXPECT_LT((half * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(Tilt, IsReadFromTheForceAndHeadsWhereXHeads) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Quaterniond truth = so3_exp(3 * normal3(2, i));
    const Eigen::Quaterniond tilt = tilt_from_specific_force(truth.conjugate() * kUp);
    EXPECT_LT(tilt_error(tilt, truth), 1e-12);
    const Eigen::Vector3d x = tilt * Eigen::Vector3d::UnitX();
    if (std::abs(x.z()) < 0.89) {
      EXPECT_NEAR(x.y(), 0, 1e-12);
      EXPECT_GT(x.x(), 0);
    }
  }
  EXPECT_EQ(tilt_from_specific_force({0, 0, 0}).w(), 1);
}

TEST(ComplementaryFilter, FollowsAPerfectSensor) {
  ComplementaryFilter filter({});
  const auto samples = readings(shaken, 3);
  double worst = 0;
  Eigen::Quaterniond start;
  for (const ImuSample& sample : samples) {
    filter.update(sample);
    const double t_s = seconds_from_ns(sample.t_ns);
    if (t_s == 0) start = shaken(0) * filter.world_from_imu().conjugate();
    worst = std::max(worst, angle_between(start * filter.world_from_imu(), shaken(t_s)));
  }
  // Trapezoids: dt^2 / 12 of the rate's change, 50 rad/s^2.
  EXPECT_LT(worst, 1e-4);
}

TEST(ComplementaryFilter, TheRateAtTheEndOfAnIntervalIsLate) {
  ComplementaryOptions options;
  options.integration = ComplementaryOptions::Integration::kEnd;
  ComplementaryFilter end(options), trapezoid({});
  double worst_end = 0, worst_trapezoid = 0;
  for (const ImuSample& sample : readings(shaken, 1, 5e-3)) {
    end.update(sample);
    trapezoid.update(sample);
    const Eigen::Quaterniond truth = shaken(seconds_from_ns(sample.t_ns));
    worst_end = std::max(worst_end, tilt_error(end.world_from_imu(), truth));
    worst_trapezoid = std::max(worst_trapezoid, tilt_error(trapezoid.world_from_imu(), truth));
  }
  EXPECT_GT(worst_end, 5 * worst_trapezoid);
}

TEST(ComplementaryFilter, PullsAWrongTiltUpWithItsTimeConstant) {
  // The sensor is turned by 0.5 rad during a gap too short to count, so that only the
  // accelerometer knows.
  for (const double tau : {0.5, 2.0}) {
    ComplementaryOptions options;
    options.time_constant_s = tau;
    options.estimate_bias = false;
    ComplementaryFilter filter(options);
    const Eigen::Quaterniond truth = so3_exp({0.5, 0, 0});
    ImuSample sample;
    sample.specific_force = kUp;
    filter.update(sample);
    sample.specific_force = truth.conjugate() * kUp;
    for (int i = 1; i <= 1000; ++i) {
      sample.t_ns = i * 1'000'000;
      filter.update(sample);
    }
    EXPECT_NEAR(tilt_error(filter.world_from_imu(), truth), 0.5 * std::exp(-1 / tau),
                0.02 * 0.5 * std::exp(-1 / tau));
  }
}

TEST(ComplementaryFilter, TheCorrectionDoesNotDependOnTheRateOfReadings) {
  const auto after_one_second = [](const std::vector<TimeNs>& steps_ms) {
    ComplementaryOptions options;
    options.estimate_bias = false;
    ComplementaryFilter filter(options);
    ImuSample sample;
    sample.specific_force = kUp;
    filter.update(sample);
    sample.specific_force = so3_exp({-0.3, 0.1, 0}) * kUp;
    for (std::size_t i = 0; sample.t_ns < 1'000'000'000; ++i) {
      sample.t_ns += 1'000'000 * steps_ms[i % steps_ms.size()];
      filter.update(sample);
    }
    return filter.world_from_imu();
  };
  const Eigen::Quaterniond even = after_one_second({1});
  EXPECT_LT(angle_between(even, after_one_second({10})), 2e-5);
  EXPECT_LT(angle_between(even, after_one_second({1, 4, 5})), 2e-5);
}

TEST(ComplementaryFilter, AccelerationIsNotTakenForGravity) {
  const auto tilt_after = [](bool adaptive) {
    ComplementaryOptions options;
    options.adaptive = adaptive;
    ComplementaryFilter filter(options);
    ImuSample sample;
    sample.specific_force = kUp;
    filter.update(sample);
    sample.specific_force = {8, 0, 9.81};
    for (int i = 1; i <= 500; ++i) {
      sample.t_ns = i * 1'000'000;
      filter.update(sample);
    }
    return tilt_error(filter.world_from_imu(), Eigen::Quaterniond::Identity());
  };
  EXPECT_LT(tilt_after(true), 1e-12);
  EXPECT_GT(tilt_after(false), 3 * kDegree);
}

TEST(ComplementaryFilter, ALargeErrorGoesByTheShortestWay) {
  // Upside down: slerp where lerp would pass through zero.
  ComplementaryOptions options;
  options.time_constant_s = 0.01;
  ComplementaryFilter filter(options);
  ImuSample sample;
  sample.specific_force = kUp;
  filter.update(sample);
  sample.specific_force = -kUp;
  for (int i = 1; i <= 200; ++i) {
    sample.t_ns = i * 1'000'000;
    filter.update(sample);
    ASSERT_TRUE(filter.world_from_imu().coeffs().allFinite());
  }
  EXPECT_LT(tilt_error(filter.world_from_imu(), so3_exp({std::numbers::pi, 0, 0})), 1e-6);
}

TEST(ComplementaryFilter, AfterAGapTheTiltIsReadAgainAndTheHeadingKept) {
  ComplementaryFilter filter({});
  ImuSample sample;
  sample.specific_force = kUp;
  for (int i = 0; i <= 500; ++i) {
    sample.t_ns = i * 1'000'000;
    sample.angular_velocity = {0, 0, 1};
    filter.update(sample);
  }
  EXPECT_EQ(filter.gaps(), 0);
  const Eigen::Quaterniond before = filter.world_from_imu();
  sample.t_ns += 1'000'000'000;
  const Eigen::Quaterniond truth = before * so3_exp({0.4, -0.2, 0});
  sample.specific_force = truth.conjugate() * kUp;
  filter.update(sample);
  EXPECT_EQ(filter.gaps(), 1);
  EXPECT_LT(tilt_error(filter.world_from_imu(), truth), 1e-12);
  EXPECT_LT(angle_between(filter.world_from_imu(), truth), 0.06) << "the heading is lost";
}

TEST(ComplementaryFilter, FreeFallAndSilenceAreSurvived) {
  ComplementaryFilter filter({});
  EXPECT_EQ(filter.world_from_imu().w(), 1);
  ImuSample sample;
  filter.update(sample);
  for (int i = 1; i <= 10; ++i) {
    sample.t_ns = i * 1'000'000;
    filter.update(sample);
  }
  EXPECT_TRUE(filter.world_from_imu().coeffs().allFinite());
}

/// At rest from 0 on, with a gyroscope's bias and noise.
ImuSample at_rest(std::uint64_t seed, int i, const Eigen::Vector3d& bias, double density) {
  const double sigma = density / std::sqrt(1e-3);
  ImuSample sample;
  sample.t_ns = static_cast<TimeNs>(i) * 1'000'000;
  sample.specific_force = kUp;
  sample.angular_velocity = bias + sigma * normal3(seed, static_cast<std::uint64_t>(i));
  return sample;
}

TEST(GyroBiasEstimator, ErrorMatchesItsSigma) {
  // Two seconds of rest determine the mean to noise / sqrt(2 s), and no estimate can be better.
  const Eigen::Vector3d bias(0.05, -0.05, 0.05);
  constexpr int kRuns = 200;
  double squares = 0, sigma = 0;
  for (int run = 0; run < kRuns; ++run) {
    GyroBiasEstimator estimate({});
    for (int i = 0; i < 2000; ++i)
      estimate.add(at_rest(static_cast<std::uint64_t>(run), i, bias, 1e-3), 1e-3);
    EXPECT_TRUE(estimate.is_at_rest());
    squares += (estimate.bias() - bias).squaredNorm() / 3;
    sigma = estimate.sigma();
  }
  const double deviation = std::sqrt(squares / kRuns);
  const double bound = 1e-3 / std::sqrt(2.0);
  EXPECT_NEAR(sigma, bound, 0.05 * bound);
  // 600 values: their deviation is known to 3 %; four of them. The first window goes unused.
  EXPECT_NEAR(deviation / bound, 1, 0.15);
}

TEST(GyroBiasEstimator, DoesNotTakeMotionForBias) {
  GyroBiasEstimator estimate({});
  for (int i = 0; i < 2000; ++i) estimate.add(at_rest(1, i, {0, 0, 0}, 1e-3), 1e-3);
  const Eigen::Vector3d before = estimate.bias();
  for (int i = 0; i < 2000; ++i) {
    ImuSample turning = at_rest(2, i, {0.1, 0, 0}, 1e-3);
    estimate.add(turning, 1e-3);
    EXPECT_FALSE(i > 200 && estimate.is_at_rest());
  }
  EXPECT_EQ(estimate.bias(), before);
}

TEST(GyroBiasEstimator, AcceleratedIsNotAtRest) {
  GyroBiasEstimator estimate({});
  for (int i = 0; i < 1000; ++i) {
    ImuSample sample = at_rest(3, i, {0.05, 0, 0}, 1e-3);
    sample.specific_force.z() += 1;
    estimate.add(sample, 1e-3);
  }
  EXPECT_FALSE(estimate.is_at_rest());
  EXPECT_EQ(estimate.bias().norm(), 0);
}

}  // namespace
}  // namespace saccade
