#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// A stretch of a camera's path as a table of poses in one frame, for the poses of very many events:
/// no search, and no sine. A pose every tenth of a millisecond; between them position and quaternion
/// are linear. At 10 rad/s and 100 rad/s^2 a direction is off by 1e-7 rad.
class DensePath {
 public:
  /// `path` is not empty; outside of it, and of [start_s, end_s], poses are held constant.
  DensePath(const Trajectory& path, double start_s, double end_s,
            const Rigid3& frame_from_world = Rigid3())
      : start_s_(start_s) {
    constexpr double kStep_s = 1e-4;
    const double length_s = std::max(0.0, end_s - start_s);
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(length_s / kStep_s)));
    steps_per_s_ = length_s > 0 ? static_cast<double>(steps) / length_s : 0;
    poses_.reserve(steps + 1);
    for (std::size_t i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(steps);
      const Rigid3 pose = frame_from_world * path.at_clamped(start_s + share * length_s);
      // Neighbours on one side of the sphere of quaternions, where q and -q are the same rotation.
      Eigen::Vector4d rotation = pose.rotation().coeffs();
      if (!poses_.empty() && rotation.dot(poses_.back().rotation) < 0) rotation = -rotation;
      poses_.push_back({rotation, pose.translation()});
    }
  }

  /// frame_from_camera.
  [[nodiscard]] Rigid3 at(double t_s) const {
    const double x =
        std::clamp((t_s - start_s_) * steps_per_s_, 0.0, static_cast<double>(poses_.size() - 1));
    const std::size_t i = std::min(static_cast<std::size_t>(x), poses_.size() - 2);
    const double share = x - static_cast<double>(i);
    const Entry &a = poses_[i], &b = poses_[i + 1];
    return {Eigen::Quaterniond(Eigen::Vector4d((1 - share) * a.rotation + share * b.rotation)),
            (1 - share) * a.position + share * b.position};
  }

 private:
  struct Entry {
    Eigen::Vector4d rotation;  ///< a quaternion's x y z w
    Eigen::Vector3d position;
  };
  double start_s_;
  double steps_per_s_ = 0;
  std::vector<Entry> poses_;  ///< two at least
};

}  // namespace saccade
