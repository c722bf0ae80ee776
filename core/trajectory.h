#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/rigid3.h"

namespace saccade {

struct StampedPose {
  double t_s = 0;
  Rigid3 world_from_camera;
};

/// Where a moving object is at one instant.
struct ObjectPose {
  double t_s = 0;
  std::uint32_t object = 0;  ///< index into the scene's mesh list
  Rigid3 world_from_object;
};

/// How the camera moves at one instant, in its own axes.
struct StampedTwist {
  double t_s = 0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// Time-stamped poses with interpolation between neighbours (slerp and straight line).
class Trajectory {
 public:
  Trajectory() = default;
  /// Times strictly increasing (contract; the file readers check it and name the line).
  explicit Trajectory(std::vector<StampedPose> poses);

  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] std::size_t size() const { return poses_.size(); }
  [[nodiscard]] std::span<const StampedPose> poses() const& { return poses_; }
  /// Of a temporary: the poses themselves, which a loop over them then keeps alive.
  [[nodiscard]] std::vector<StampedPose> poses() && { return std::move(poses_); }
  [[nodiscard]] double start_s() const { return poses_.front().t_s; }
  [[nodiscard]] double end_s() const { return poses_.back().t_s; }

  /// Pose at `t_s`; nullopt outside [start, end]. O(log n).
  [[nodiscard]] std::optional<Rigid3> at(double t_s) const;
  /// Pose at `t_s`, held constant outside [start, end]. The trajectory is not empty.
  [[nodiscard]] Rigid3 at_clamped(double t_s) const;

  /// Index of the last pose with time <= t_s; nullopt when there is none.
  [[nodiscard]] std::optional<std::size_t> last_before(double t_s) const;

  /// Sum of the distances between consecutive positions [m].
  [[nodiscard]] double path_length() const;

 private:
  std::vector<StampedPose> poses_;
};

}  // namespace saccade
