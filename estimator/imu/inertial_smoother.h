#pragma once

#include <span>
#include <vector>

#include "core/imu_sample.h"
#include "estimator/imu/inertial_bank.h"
#include "estimator/imu/orientation.h"

namespace saccade {

/// Orientations by all that is known after the recording: an InertialBank runs forwards in time and,
/// with what it knows then, back again, as of a sensor that turns and moves the other way. Ten times
/// a second the two estimates of tilt, velocity and biases are merged by their covariances, as in a
/// two-filter smoother (D. Fraser and J. Potter, IEEE TAC 14(4), 1969), but that the way back begins
/// with what the way out has found: one that knows nothing and begins amid a motion takes many
/// seconds and believes in what it errs meanwhile. In between the gyroscope turns, less the merged
/// bias. One estimate per sample; `samples` are in order of time.
[[nodiscard]] std::vector<ImuOrientation> smooth_orientations(std::span<const ImuSample> samples,
                                                              const InertialFilterOptions& options,
                                                              const GyroscopeNoise& gyroscope);

/// The estimate of both, which may have worlds of different headings: `one`, whose tilt, velocity and
/// biases are moved to the mean by the covariances. Its heading and its gyroscope's bias about the
/// vertical, which nothing measures well, are left.
[[nodiscard]] InertialState merged_state(const InertialState& one, const InertialState& another);

}  // namespace saccade
