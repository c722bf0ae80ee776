#pragma once

#include "simulator/camera_recording.h"

namespace saccade {

/// Writes the poses and twists of the camera and the poses of moving objects; returns the length of
/// its path [m].
double record_groundtruth(const CameraRecording& recording);

/// Writes the inertial sensor's readings, with their truth and calibration, where it is on.
void record_imu(const CameraRecording& recording);

}  // namespace saccade
