#include "core/pose_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/median.h"
#include "core/spline/spline.h"

namespace saccade {
namespace {

constexpr std::size_t kReach = 2;  ///< neighbours on each side, through which the cubic goes
constexpr double kSigmaPerMedian = 1.4826;  ///< of the absolute value of a normal variable
constexpr double kSampling_s = 1e-3;  ///< within which a straight line follows any hand's motion

constexpr double kLongestKnots = 4;  ///< without a pose: in longer gaps nothing holds the spline

/// Weights of the four neighbours in the cubic's value at pose `i` (Lagrange).
std::array<double, 2 * kReach> cubic_weights(std::span<const StampedPose> poses, std::size_t i) {
  const std::array<std::size_t, 2 * kReach> at{i - 2, i - 1, i + 1, i + 2};
  std::array<double, 2 * kReach> weights{};
  for (std::size_t a = 0; a < at.size(); ++a) {
    weights[a] = 1;
    for (std::size_t b = 0; b < at.size(); ++b)
      if (a != b)
        weights[a] *= (poses[i].t_s - poses[at[b]].t_s) / (poses[at[a]].t_s - poses[at[b]].t_s);
  }
  return weights;
}

/// Absolute deviations, per axis, of every pose from its neighbours, in standard deviations of one
/// pose: the neighbours' own noise is divided out.
struct Deviations {
  std::vector<double> rotation_rad, position_m;
};

Deviations deviations_of(std::span<const StampedPose> poses) {
  Deviations found;
  for (std::size_t i = kReach; i + kReach < poses.size(); ++i) {
    const std::array<double, 2 * kReach> weights = cubic_weights(poses, i);
    const Rigid3& pose = poses[i].world_from_camera;
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero(), position = Eigen::Vector3d::Zero();
    double variance = 1;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const Rigid3& other = poses[i + k - kReach + (k < kReach ? 0 : 1)].world_from_camera;
      rotation += weights[k] * so3_log(pose.rotation().conjugate() * other.rotation());
      position += weights[k] * (other.translation() - pose.translation());
      variance += weights[k] * weights[k];
    }
    for (int axis = 0; axis < 3; ++axis) {
      found.rotation_rad.push_back(std::abs(rotation[axis]) / std::sqrt(variance));
      found.position_m.push_back(std::abs(position[axis]) / std::sqrt(variance));
    }
  }
  return found;
}

double median_spacing_s(std::span<const StampedPose> poses) {
  std::vector<double> spacings;
  for (std::size_t i = 1; i < poses.size(); ++i)
    spacings.push_back(poses[i].t_s - poses[i - 1].t_s);
  return median(std::move(spacings));
}

}  // namespace

double PoseNoise::poses_within(double duration_s) const {
  return spacing_s > 0 ? std::max(1.0, duration_s / spacing_s) : 1.0;
}

PoseNoise pose_noise_of(const Trajectory& trajectory) {
  const std::span<const StampedPose> poses = trajectory.poses();
  if (poses.size() <= 2 * kReach) return {};
  Deviations deviations = deviations_of(poses);
  return {kSigmaPerMedian * median(std::move(deviations.rotation_rad)),
          kSigmaPerMedian * median(std::move(deviations.position_m)), median_spacing_s(poses)};
}

Trajectory smoothed(const Trajectory& trajectory, double knot_spacing_s) {
  const Spline spline = Spline::smooth(trajectory.poses(), knot_spacing_s);
  std::vector<StampedPose> poses;
  const auto add = [&](double t_s) { poses.push_back({t_s, spline.pose(t_s)}); };
  for (const StampedPose& pose : trajectory.poses()) {
    if (!poses.empty()) {
      const double from_s = poses.back().t_s;
      const bool is_gap = pose.t_s - from_s > kLongestKnots * knot_spacing_s;
      const auto steps =
          is_gap ? 1 : static_cast<std::size_t>(std::ceil((pose.t_s - from_s) / kSampling_s));
      for (std::size_t k = 1; k < steps; ++k)
        add(from_s + static_cast<double>(k) / static_cast<double>(steps) * (pose.t_s - from_s));
    }
    add(pose.t_s);
  }
  return Trajectory(std::move(poses));
}

}  // namespace saccade
