#pragma once

#include <span>
#include <vector>

#include "core/imu_sample.h"
#include "core/rigid3.h"
#include "core/trajectory.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// What of a run and its dataset goes into the scores of orientation.
struct OrientationScoreInput {
  Trajectory estimate;                   ///< world_from_camera, z up, any heading
  Trajectory truth;                      ///< empty: nothing is scored
  std::vector<GyroBiasEstimate> biases;  ///< perhaps none
  std::vector<ImuTruth> imu_truth;       ///< perhaps none
};

/// One estimated orientation against the truth.
struct OrientationError {
  double t_s = 0;
  double tilt_rad = 0;     ///< between the up directions
  double heading_rad = 0;  ///< about the vertical, continuous over time, 0 at the start
};

/// Of every estimate within the truth's time. With D = R_estimate R_truth^T: tilt is the angle
/// between D z and z, heading 2 atan2(q_z, q_w) of D.
[[nodiscard]] std::vector<OrientationError> orientation_errors(const Trajectory& estimate,
                                                               const Trajectory& truth);

/// orientation.roll_pitch_rmse_deg (RMS of the tilt's error, which is the error of roll and pitch
/// together), orientation.yaw_drift_deg_per_min (slope of the heading's error by least squares, its
/// size; from the end of the first rest on, where biases are given),
/// orientation.bias_error_rad_s (RMS over the axes at the end of the first rest) and
/// orientation.bias_sigma_rad_s (what the filter believed it to be).
[[nodiscard]] Metrics score_orientation(const OrientationScoreInput& input);

/// Of angular velocities within the truth's time: orientation.rate_rmse_rad_s (RMS of the length of
/// the difference), orientation.rate_peak_rad_s (the truth's largest length at those times) and
/// orientation.rate_rmse_percent (of that). The truth is linear between its entries.
[[nodiscard]] Metrics score_rates(std::span<const StampedTwist> estimate,
                                  std::span<const StampedTwist> truth);

/// The same where only a gyroscope tells, as in a recording. An estimate stands for the time from
/// half-way to the one before it to half-way to the next, over which the readings are averaged: single
/// ones have the noise and the vibration of milliseconds. The gyroscope's bias is unknown, so the mean
/// difference of each axis is removed. Estimates at the ends stand for as long on either side.
/// `camera_from_imu`: only its rotation counts. Nothing is scored with fewer than two estimates.
[[nodiscard]] Metrics score_rates_by_gyroscope(std::span<const StampedTwist> estimate,
                                               std::span<const ImuSample> gyroscope,
                                               const Rigid3& camera_from_imu);

}  // namespace saccade
