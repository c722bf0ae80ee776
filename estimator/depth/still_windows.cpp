#include "estimator/depth/still_windows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "core/event.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

constexpr std::size_t kMostJoined = 5;
/// Poses that are looked at per window: of 0.4 s, those of a hand that is shaken five times a second
/// miss its turning points by a fiftieth of its way at most.
constexpr int kPosesPerWindow = 32;
/// Mean distance of a pixel from the centre of a square image, in widths of it.
constexpr double kMeanRadius = 0.38;

/// How the camera moves over consecutive windows, seen from where it was at their beginning.
class Motion {
 public:
  Motion(const ViewWindow& first, const ParallaxDemand& demand) : demand_(demand) {
    start_from_world_ = pose_at(first, 0).inverse();
    add(first);
  }

  void add(const ViewWindow& window) {
    for (int i = 0; i < kPosesPerWindow; ++i) {
      const Rigid3 pose =
          start_from_world_ * pose_at(window, static_cast<double>(i) / (kPosesPerWindow - 1));
      lowest_ = lowest_.cwiseMin(pose.translation());
      highest_ = highest_.cwiseMax(pose.translation());
      turn_rad_ = std::max(turn_rad_, so3_log(pose.rotation()).norm());
    }
  }

  /// Sideways all points of one depth move alike; along the view each in proportion to its distance
  /// from the centre.
  [[nodiscard]] bool is_enough() const {
    const PinholeCamera& camera = demand_.camera;
    const Eigen::Vector3d way = highest_ - lowest_;
    const double radius_px =
        kMeanRadius * std::sqrt(static_cast<double>(camera.width) * camera.height);
    const Eigen::Vector3d moved_px{camera.fx * way.x(), camera.fy * way.y(), radius_px * way.z()};
    return moved_px.norm() >= demand_.least_px * demand_.mean_depth_m;
  }

  [[nodiscard]] bool stays_in_view() const {
    const PinholeCamera& camera = demand_.camera;
    const double half_view = std::min(camera.width / camera.fx, camera.height / camera.fy) / 2;
    return turn_rad_ <= std::atan(half_view);
  }

 private:
  [[nodiscard]] static Rigid3 pose_at(const ViewWindow& window, double fraction) {
    const double from_s = seconds_from_ns(window.events.front().t_ns);
    const double to_s = seconds_from_ns(window.events.back().t_ns);
    return window.trajectory->at_clamped(from_s + fraction * (to_s - from_s));
  }

  const ParallaxDemand& demand_;
  Rigid3 start_from_world_;
  Eigen::Vector3d lowest_ = Eigen::Vector3d::Zero(), highest_ = Eigen::Vector3d::Zero();
  double turn_rad_ = 0;
};

/// Windows [first, last).
struct Group {
  std::size_t first, last;

  [[nodiscard]] Motion motion(const std::vector<ViewWindow>& windows,
                              const ParallaxDemand& demand) const {
    Motion motion(windows[first], demand);
    for (std::size_t i = first + 1; i < last; ++i) motion.add(windows[i]);
    return motion;
  }
};

/// From `first` on as many windows as the demand asks for, and may have.
Group group_from(std::size_t first, const std::vector<ViewWindow>& windows,
                 const ParallaxDemand& demand) {
  Motion motion(windows[first], demand);
  std::size_t last = first + 1;
  const std::size_t end = std::min(windows.size(), first + kMostJoined);
  for (; last < end && !motion.is_enough(); ++last) {
    motion.add(windows[last]);
    if (!motion.stays_in_view()) break;
  }
  return {first, last};
}

}  // namespace

std::vector<ViewWindow> join_still_windows(const std::vector<ViewWindow>& windows,
                                           const ParallaxDemand& demand,
                                           const ViewWindowOptions& options,
                                           const std::vector<StampedFile>& frames) {
  std::vector<Group> groups;
  for (std::size_t first = 0; first < windows.size(); first = groups.back().last)
    groups.push_back(group_from(first, windows, demand));
  if (groups.size() > 1 && !groups.back().motion(windows, demand).is_enough()) {
    const Group both{groups[groups.size() - 2].first, groups.back().last};
    if (both.last - both.first <= kMostJoined && both.motion(windows, demand).stays_in_view()) {
      groups.pop_back();
      groups.back() = both;
    }
  }
  std::vector<ViewWindow> joined;
  for (const Group& group : groups) {
    const std::span<const Event> from = windows[group.first].events;
    const std::span<const Event> to = windows[group.last - 1].events;
    const std::span<const Event> events(from.data(), to.data() + to.size());
    joined.push_back(view_of(events, *windows[group.first].trajectory, options, frames));
  }
  return joined;
}

}  // namespace saccade
