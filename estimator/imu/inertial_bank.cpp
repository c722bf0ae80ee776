#include "estimator/imu/inertial_bank.h"

#include <algorithm>
#include <cmath>

#include "core/rigid3.h"

namespace saccade {
namespace {

/// A sensor in use keeps the character of its motion for some ten seconds. A fifth or five times of
/// this changed errors by a tenth.
constexpr double kChangesPerSecond = 0.1;
/// The filters are mixed so often, since a mean over covariances costs as much as ten samples.
constexpr double kMixing_s = 0.1;
/// Velocities that the filters take for usual, relative to the stated sigma. The reach of the position
/// is the same for all: a slow sensor gets as far as a fast one.
constexpr std::array<double, InertialBank::kFilters> kVelocityFactors{1, 1.0 / 5, 1.0 / 25};
/// Where the filters disagree their mean jumps by degrees as their probabilities change, and events
/// that are moved by it blur. With half a second 3 % of the events of a shaken camera were more than
/// a pixel off, with one second 1 %, with three as many.
constexpr double kFollowing_s = 1;
/// No filter is given up for good.
constexpr double kLeastProbability = 1e-12;

using State = InertialState;

InertialFilterOptions with_velocity(InertialFilterOptions options, double factor) {
  options.velocity_sigma *= factor;
  return options;
}

State moved(const State& state, const State::Errors& by) {
  State to = state;
  to.world_from_imu = (so3_exp(by.segment<3>(State::kTheta)) * state.world_from_imu).normalized();
  to.bias += by.segment<3>(State::kBias);
  to.velocity += by.segment<3>(State::kVelocity);
  to.accel_bias += by.segment<3>(State::kAccelBias);
  to.position += by.segment<3>(State::kPosition);
  return to;
}

}  // namespace

InertialBank::InertialBank(const InertialFilterOptions& options, const GyroscopeNoise& gyroscope)
    : filters_{InertialFilter(with_velocity(options, kVelocityFactors[0]), gyroscope),
               InertialFilter(with_velocity(options, kVelocityFactors[1]), gyroscope),
               InertialFilter(with_velocity(options, kVelocityFactors[2]), gyroscope)} {
  probabilities_.fill(1.0 / kFilters);
}

void InertialBank::update(const ImuSample& sample) {
  for (InertialFilter& filter : filters_) filter.update(sample);
  weigh();
  const double dt_s = has_last_ ? seconds_from_ns(sample.t_ns - last_.t_ns) : 0;
  unmixed_s_ += dt_s;
  if (unmixed_s_ >= kMixing_s) {
    mix(unmixed_s_);
    unmixed_s_ = 0;
  }
  const AllErrors all = errors();
  State::Errors mean = State::Errors::Zero();
  for (std::size_t i = 0; i < kFilters; ++i) mean += probabilities_[i] * all[i];
  const State& about = filters_[likeliest_].state();
  bias_ = about.bias + mean.segment<3>(State::kBias);
  world_from_imu_ = (so3_exp(mean.segment<3>(State::kTheta)) * about.world_from_imu).normalized();
  follow(sample, dt_s);
  last_ = sample;
  has_last_ = true;
}

InertialBank InertialBank::turned_back() const {
  InertialBank back = *this;
  for (InertialFilter& filter : back.filters_) filter = filter.turned_back();
  back.last_ = reversed(last_);
  back.bias_ = -bias_;
  return back;
}

void InertialBank::follow(const ImuSample& sample, double dt_s) {
  if (!has_last_ || dt_s > kMaxImuGap_s) {
    continuous_ = world_from_imu_;
    return;
  }
  const Eigen::Vector3d rate = 0.5 * (last_.angular_velocity + sample.angular_velocity) - bias_;
  const Eigen::Quaterniond turned = continuous_ * so3_exp(dt_s * rate);
  const Eigen::Vector3d apart = so3_log(world_from_imu_ * turned.conjugate());
  continuous_ = (so3_exp(-std::expm1(-dt_s / kFollowing_s) * apart) * turned).normalized();
}

void InertialBank::weigh() {
  Probabilities evidence;  // logarithms
  for (std::size_t i = 0; i < kFilters; ++i) evidence[i] = filters_[i].take_log_likelihood();
  if (evidence == Probabilities{}) return;  // nothing was measured since the last sample
  for (std::size_t i = 0; i < kFilters; ++i) evidence[i] += std::log(probabilities_[i]);
  const double most = *std::max_element(evidence.begin(), evidence.end());
  double sum = 0;
  for (std::size_t i = 0; i < kFilters; ++i) {
    probabilities_[i] = std::max(kLeastProbability, std::exp(evidence[i] - most));
    sum += probabilities_[i];
  }
  for (double& probability : probabilities_) probability /= sum;
  likeliest_ = static_cast<std::size_t>(
      std::max_element(probabilities_.begin(), probabilities_.end()) - probabilities_.begin());
}

void InertialBank::mix(double interval_s) {
  // Of a chain that goes from each state to every other one alike; after a long gap nothing is known.
  constexpr double kOthers = kFilters - 1;
  const double changed =
      kOthers / kFilters * -std::expm1(-kChangesPerSecond * interval_s * kFilters / kOthers);
  for (InertialFilter& filter : filters_) filter.propagate();
  const AllErrors all = errors();
  std::array<State, kFilters> mixed;
  Probabilities next;
  for (std::size_t to = 0; to < kFilters; ++to) {
    Probabilities from;
    next[to] = 0;
    for (std::size_t i = 0; i < kFilters; ++i) {
      from[i] = (i == to ? 1 - changed : changed / kOthers) * probabilities_[i];
      next[to] += from[i];
    }
    for (double& weight : from) weight /= next[to];
    mixed[to] = mixture(all, from);
  }
  for (std::size_t i = 0; i < kFilters; ++i) filters_[i].set_state(mixed[i]);
  probabilities_ = next;
}

InertialState InertialBank::mixture(const AllErrors& all, const Probabilities& weights) const {
  State::Errors mean = State::Errors::Zero();
  for (std::size_t i = 0; i < kFilters; ++i) mean += weights[i] * all[i];
  State mixed = moved(filters_[likeliest_].state(), mean);
  mixed.covariance.setZero();
  for (std::size_t i = 0; i < kFilters; ++i) {
    const State::Errors apart = all[i] - mean;
    mixed.covariance += weights[i] * (filters_[i].state().covariance + apart * apart.transpose());
  }
  return mixed;
}

InertialState InertialBank::state() {
  for (InertialFilter& filter : filters_) filter.propagate();
  return mixture(errors(), probabilities_);
}

auto InertialBank::errors() const -> AllErrors {
  const State& about = filters_[likeliest_].state();
  AllErrors all;
  for (std::size_t i = 0; i < kFilters; ++i) {
    const State& state = filters_[i].state();
    all[i] << so3_log(state.world_from_imu * about.world_from_imu.conjugate()),
        state.bias - about.bias, state.velocity - about.velocity,
        state.accel_bias - about.accel_bias, state.position - about.position;
  }
  return all;
}

double InertialBank::variance(int first, int size) const {
  const AllErrors all = errors();
  State::Errors mean = State::Errors::Zero();
  for (std::size_t i = 0; i < kFilters; ++i) mean += probabilities_[i] * all[i];
  double sum = 0;
  for (std::size_t i = 0; i < kFilters; ++i)
    sum +=
        probabilities_[i] * (filters_[i].state().covariance.diagonal().segment(first, size).sum() +
                             (all[i] - mean).segment(first, size).squaredNorm());
  return sum / size;
}

double InertialBank::bias_sigma() const { return std::sqrt(variance(State::kBias, 3)); }

double InertialBank::tilt_sigma() const { return std::sqrt(variance(State::kTheta, 2)); }

}  // namespace saccade
