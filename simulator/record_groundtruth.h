#pragma once

#include "simulator/take.h"

namespace saccade {

/// Writes the camera's poses and twists; returns the length of its path [m].
double record_groundtruth(const Take& take);

/// Writes the inertial sensor's readings, with their truth and calibration, where it is on.
void record_imu(const Take& take);

}  // namespace saccade
