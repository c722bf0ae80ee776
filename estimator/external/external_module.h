#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/imu_sample.h"
#include "core/trajectory.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run external`: an external program over a dataset (docs/own_estimator.md). A
/// crash, a time-out and bad output are a status of the run, which then holds no poses; a program
/// that cannot be started is an InputError.
RunSummary run_external(const RunRequest& request);

/// What a method in this process is given.
struct MethodInputs {
  PinholeCamera camera;           ///< with its lens
  std::span<const Event> events;  ///< of the window
  Trajectory start;               ///< the true poses of start.truth_s
  std::vector<ImuSample> imu;     ///< of the window, where the class has `imu`
  std::uint64_t seed = 1;
};

/// What it found, and its time without the preparation of inputs.
struct MethodResult {
  std::vector<StampedPose> poses;  ///< world_from_camera, times increasing
  double wall_s = 0;
};

/// The same of a method in this process; the adapter (request.config) states no command. An
/// exception of the method ends the run, of which nothing is left.
RunSummary run_method(const RunRequest& request,
                      const std::function<MethodResult(const MethodInputs&)>& method);

}  // namespace saccade
