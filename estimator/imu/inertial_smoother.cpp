#include "estimator/imu/inertial_smoother.h"

#include <Eigen/LU>

#include <cmath>
#include <cstddef>

#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/imu/orientation_smoothing.h"
#include "estimator/imu/tilt.h"

namespace saccade {
namespace {

using State = InertialState;

/// Biases and tilt change by far less meanwhile than either direction knows them.
constexpr double kKnot_s = 0.1;

/// What is merged: tilt, the gyroscope's bias about horizontal axes, velocity and the
/// accelerometer's bias.
constexpr int kShared = 10;
using Shared = Eigen::Matrix<double, kShared, 1>;
using SharedCovariance = Eigen::Matrix<double, kShared, kShared>;
constexpr int kSharedTheta = 0, kSharedBias = 2, kSharedVelocity = 4, kSharedAccelBias = 7;

/// The rows of a state's errors that are merged, those of the gyroscope's bias in the world's axes:
/// of `theta` and `bias` the first two, since nothing measures the others.
Eigen::Matrix<double, kShared, 15> shared_rows(const Eigen::Matrix3d& world_from_imu) {
  Eigen::Matrix<double, kShared, 15> rows;
  rows.setZero();
  rows.block<2, 2>(kSharedTheta, State::kTheta).setIdentity();
  rows.block<2, 3>(kSharedBias, State::kBias) = world_from_imu.topRows<2>();
  rows.block<3, 3>(kSharedVelocity, State::kVelocity).setIdentity();
  rows.block<3, 3>(kSharedAccelBias, State::kAccelBias).setIdentity();
  return rows;
}

/// The same state in a world that is turned about the vertical; the position is left out.
State turned(const State& state, double heading) {
  const Eigen::Quaterniond turn = so3_exp({0, 0, heading});
  State to = state;
  to.world_from_imu = turn * state.world_from_imu;
  to.velocity = turn * state.velocity;
  State::Covariance change = State::Covariance::Identity();
  for (const int first : {State::kTheta, State::kVelocity, State::kPosition})
    change.block<3, 3>(first, first) = turn.toRotationMatrix();
  to.covariance = change * state.covariance * change.transpose();
  return to;
}

/// Whether it is not known how the sensor turned from sample `i` to the next one.
bool is_gap(std::span<const ImuSample> samples, std::size_t i) {
  return seconds_from_ns(samples[i + 1].t_ns - samples[i].t_ns) > kMaxImuGap_s;
}

/// The samples at which states are merged: some a second, the ends, and those around gaps.
std::vector<std::size_t> knots_of(std::span<const ImuSample> samples) {
  std::vector<std::size_t> knots{0};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const bool is_after_gap = is_gap(samples, i - 1);
    const bool is_last = i + 1 == samples.size();
    const bool is_before_gap = !is_last && is_gap(samples, i);
    const double since_s = seconds_from_ns(samples[i].t_ns - samples[knots.back()].t_ns);
    if (since_s >= kKnot_s || is_last || is_before_gap || is_after_gap) knots.push_back(i);
  }
  return knots;
}

/// The heading of an orientation relative to another one.
double heading_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Matrix3d apart = (to * from.conjugate()).toRotationMatrix();
  return std::atan2(apart(1, 0) - apart(0, 1), apart(0, 0) + apart(1, 1));
}

/// What both directions know together at a knot.
struct Knot {
  Eigen::Quaterniond world_from_imu;
  Eigen::Vector3d bias;
  double bias_sigma;
};

/// The orientations between two knots, as the gyroscope turns; what it misses of the second one is
/// spread over the time.
class Segment {
 public:
  /// `samples`: from that of the first knot to that of the second one, not at the same time.
  Segment(std::span<const ImuSample> samples, const Knot& from, const Knot& to)
      : samples_(samples), from_(from), to_(to), turned_{from.world_from_imu} {
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const Eigen::Vector3d rate =
          0.5 * (samples[i - 1].angular_velocity + samples[i].angular_velocity) -
          bias(0.5 * (time(i - 1) + time(i)));
      const double dt_s = seconds_from_ns(samples[i].t_ns - samples[i - 1].t_ns);
      turned_.push_back((turned_.back() * so3_exp(dt_s * rate)).normalized());
    }
    missed_ = so3_log(to.world_from_imu * turned_.back().conjugate());
  }

  /// By the gyroscope alone.
  [[nodiscard]] Eigen::Quaterniond turn() const {
    return turned_.front().conjugate() * turned_.back();
  }
  [[nodiscard]] ImuOrientation at(std::size_t i) const {
    const Eigen::Quaterniond orientation = (so3_exp(time(i) * missed_) * turned_[i]).normalized();
    return {orientation, orientation, {samples_[i].t_ns, bias(time(i)), to_.bias_sigma, false}};
  }

 private:
  /// 0 at the begin, 1 at the end.
  [[nodiscard]] double time(std::size_t i) const {
    return static_cast<double>(samples_[i].t_ns - samples_.front().t_ns) /
           static_cast<double>(samples_.back().t_ns - samples_.front().t_ns);
  }
  [[nodiscard]] Eigen::Vector3d bias(double time) const {
    return from_.bias + time * (to_.bias - from_.bias);
  }

  std::span<const ImuSample> samples_;
  const Knot& from_;
  const Knot& to_;
  std::vector<Eigen::Quaterniond> turned_;  ///< by the gyroscope alone
  Eigen::Vector3d missed_;
};

/// What the estimates of knots depart from the gyroscope's path changes slowly; what trembles in it
/// is of the filters, and would shake what is moved by the orientations. So it goes through a
/// low-pass filter, from one gap to the next.
void calm(std::span<const ImuSample> samples, std::span<const std::size_t> at,
          std::vector<Knot>& knots) {
  // Of a camera that is shaken at 12 rad/s 2.3 % of the events are more than a pixel off without it,
  // 0.25 % with 0.3 s and 0.14 % with 1 s, by which its heading begins to suffer.
  constexpr double kCalm_s = 0.5;
  const SmoothingOptions low_pass{.time_constant_s = kCalm_s, .max_angle_deg = 180};
  for (std::size_t begin = 0, end = 0; begin < knots.size(); begin = end) {
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
    std::vector<Eigen::Quaterniond> by_gyroscope;
    std::vector<StampedPose> departures;
    for (end = begin; end < knots.size(); ++end) {
      if (end > begin) {
        if (is_gap(samples, at[end] - 1)) break;
        turned = turned * Segment(samples.subspan(at[end - 1], at[end] - at[end - 1] + 1),
                                  knots[end - 1], knots[end])
                              .turn();
      }
      by_gyroscope.push_back(turned);
      departures.push_back({seconds_from_ns(samples[at[end]].t_ns),
                            {knots[end].world_from_imu * turned.conjugate(), {0, 0, 0}}});
    }
    const Trajectory calmed = smoothed_orientations(Trajectory(std::move(departures)), low_pass);
    for (std::size_t k = begin; k < end; ++k)
      knots[k].world_from_imu =
          calmed.poses()[k - begin].world_from_camera.rotation() * by_gyroscope[k - begin];
  }
}

double bias_sigma(const State& state) {
  return std::sqrt(state.covariance.diagonal().segment<3>(State::kBias).mean());
}

}  // namespace

InertialState merged_state(const InertialState& one, const InertialState& another) {
  const State other = turned(another, heading_between(another.world_from_imu, one.world_from_imu));
  State::Errors apart_errors;
  apart_errors << so3_log(other.world_from_imu * one.world_from_imu.conjugate()),
      other.bias - one.bias, other.velocity - one.velocity, other.accel_bias - one.accel_bias,
      Eigen::Vector3d::Zero();
  const auto rows = shared_rows(one.world_from_imu.toRotationMatrix());
  const SharedCovariance own = rows * one.covariance * rows.transpose();
  const SharedCovariance sum = own + rows * other.covariance * rows.transpose();
  const SharedCovariance gain = own * sum.inverse();
  const Shared change = gain * (rows * apart_errors);
  const State::Errors by = rows.transpose() * change;
  State merged = one;
  merged.world_from_imu = (so3_exp(by.segment<3>(State::kTheta)) * one.world_from_imu).normalized();
  merged.bias += by.segment<3>(State::kBias);
  merged.velocity += by.segment<3>(State::kVelocity);
  merged.accel_bias += by.segment<3>(State::kAccelBias);
  // What is not merged keeps what it had.
  const SharedCovariance less = gain * own;
  merged.covariance -= 0.5 * rows.transpose() * (less + less.transpose()) * rows;
  return merged;
}

std::vector<ImuOrientation> smooth_orientations(std::span<const ImuSample> samples,
                                                const InertialFilterOptions& options,
                                                const GyroscopeNoise& gyroscope) {
  if (samples.empty()) return {};
  const std::vector<std::size_t> at = knots_of(samples);
  InertialBank bank(options, gyroscope);
  std::vector<State> forward;
  std::vector<bool> is_at_rest;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    bank.update(samples[i]);
    is_at_rest.push_back(bank.is_at_rest());
    if (at[forward.size()] == i) forward.push_back(bank.state());
  }

  std::vector<Knot> knots(at.size());
  const auto set_knot = [&](std::size_t k, const State& backward) {
    const State both = k + 1 == at.size() ? forward[k] : merged_state(backward, forward[k]);
    // The heading is that of the way back, too, which has known the bias better from its start on.
    const Eigen::Vector3d up = both.world_from_imu.conjugate() * Eigen::Vector3d::UnitZ();
    knots[k] = {corrected_tilt(bank.continuous(), up), both.bias, bias_sigma(both)};
  };
  set_knot(at.size() - 1, forward.back());
  bank = bank.turned_back();
  for (std::size_t i = samples.size() - 1, k = at.size() - 1; i-- > 0;) {
    bank.update(reversed(samples[i]));
    if (at[k - 1] == i) set_knot(--k, reversed(bank.state()));
  }
  calm(samples, at, knots);
  const Eigen::Quaterniond first = knots.front().world_from_imu;
  const Eigen::Quaterniond without_heading =
      tilt_from_specific_force(first.conjugate() * Eigen::Vector3d::UnitZ());
  const Eigen::Quaterniond turn = so3_exp({0, 0, heading_between(first, without_heading)});
  for (Knot& knot : knots) knot.world_from_imu = turn * knot.world_from_imu;

  std::vector<ImuOrientation> orientations{
      {knots.front().world_from_imu,
       knots.front().world_from_imu,
       {samples.front().t_ns, knots.front().bias, knots.front().bias_sigma, is_at_rest.front()}}};
  orientations.reserve(samples.size());
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const Segment segment(samples.subspan(at[k], at[k + 1] - at[k] + 1), knots[k], knots[k + 1]);
    for (std::size_t i = 1; i <= at[k + 1] - at[k]; ++i) {
      orientations.push_back(segment.at(i));
      orientations.back().gyro.at_rest = is_at_rest[at[k] + i];
    }
  }
  return orientations;
}

}  // namespace saccade
