#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "estimator/imu/imu_input.h"

namespace saccade {

/// Whether events show that their camera turns at a slow rate that its gyroscope reads, or stands
/// still so that the reading is a bias: moved along with the turn the image of the events is sharp,
/// against it blurred, and of a camera at rest both are alike.
class TurningEvents {
 public:
  /// `rate`: in the camera's axes [rad/s]; the events are moved to `at_ns`.
  TurningEvents(const PinholeCamera& camera, const Eigen::Vector3d& rate, TimeNs at_ns);

  void add(std::span<const Event> events);
  /// False as long as there are too few events to tell.
  [[nodiscard]] bool show_turn() const;

 private:
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
  Eigen::Vector3d rate_;
  TimeNs at_ns_;
  Image<std::uint8_t> fired_;  ///< events by pixel
  ImageF along_, against_;
  std::size_t count_ = 0;
};

/// Marks the samples of windows in which the sensor might be at rest by what it reads
/// (RestDetector), but the dataset's events show that it turns, as may_rest = false. A slow pan at a
/// constant rate about the vertical differs from a bias in nothing else. Reads the events once, from
/// the first such window to the last.
void mark_turns(ImuInput& imu, const Dataset& dataset);

}  // namespace saccade
