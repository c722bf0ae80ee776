#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/imu_sample.h"
#include "estimator/imu/inertial_filter.h"

namespace saccade {

/// Orientation by inertial filters that differ in how fast they take the sensor to move: as stated,
/// a fifth and a twenty-fifth of that. A bound that is far wider than the motion leaves the tilt of
/// the first sample and the gyroscope's bias as they are for seconds; one that is too narrow takes
/// acceleration for tilt. Which of them holds may change with the motion, and follows from the
/// likelihood of their pseudo-measurements: an interacting multiple model estimator (H. Blom and
/// Y. Bar-Shalom, IEEE TAC 33(8), 1988). Its estimate is the mean over the filters by their
/// probabilities.
class InertialBank {
 public:
  explicit InertialBank(const InertialFilterOptions& options, const GyroscopeNoise& gyroscope = {});

  /// Adds a sample; times increase (contract).
  void update(const ImuSample& sample);

  /// These filters on the way back (InertialFilter::turned_back()).
  [[nodiscard]] InertialBank turned_back() const;

  [[nodiscard]] const Eigen::Quaterniond& world_from_imu() const { return world_from_imu_; }
  /// The same without its jumps, for what is moved by it: it turns with the gyroscope and follows
  /// within a second.
  [[nodiscard]] const Eigen::Quaterniond& continuous() const { return continuous_; }
  /// All that the filters know together, at the time of the last sample.
  [[nodiscard]] InertialState state();
  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  ///< [rad/s]
  [[nodiscard]] double bias_sigma() const;  ///< of one component, RMS [rad/s]
  [[nodiscard]] double tilt_sigma() const;  ///< of one component, RMS [rad]
  /// In the last 0.1 s, as the likeliest filter has it.
  [[nodiscard]] bool is_at_rest() const { return filters_[likeliest_].is_at_rest(); }
  /// Number of gaps longer than 0.1 s between samples.
  [[nodiscard]] int gaps() const { return filters_.front().gaps(); }

  static constexpr std::size_t kFilters = 3;
  using Probabilities = std::array<double, kFilters>;
  /// Of the filters, the fastest first.
  [[nodiscard]] const Probabilities& probabilities() const { return probabilities_; }

 private:
  /// States about that of the likeliest filter.
  using AllErrors = std::array<InertialState::Errors, kFilters>;
  [[nodiscard]] AllErrors errors() const;
  /// The mean of the filters with these weights, and their covariances and spread; `all`: errors(),
  /// to whose time they were propagated.
  [[nodiscard]] InertialState mixture(const AllErrors& all, const Probabilities& weights) const;
  /// Variance of `size` components of the mean from `first` on, each: the filters' and their spread.
  [[nodiscard]] double variance(int first, int size) const;
  /// Updates the probabilities by the likelihoods.
  void weigh();
  /// Turns continuous() with the gyroscope, and a little towards the mean of the filters.
  void follow(const ImuSample& sample, double dt_s);
  /// Has each filter go on from a mean over all, by how often motion changes its character.
  void mix(double interval_s);

  std::array<InertialFilter, kFilters> filters_;
  Probabilities probabilities_;
  std::size_t likeliest_ = 0;
  double unmixed_s_ = 0;  ///< since the filters were mixed last
  ImuSample last_;
  bool has_last_ = false;
  Eigen::Quaterniond world_from_imu_ = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond continuous_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
};

}  // namespace saccade
