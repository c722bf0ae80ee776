#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// The freedom that is taken out of an estimate before it is compared with the truth.
/// kYaw: a translation and a rotation about the world's z axis, which is vertical. It is what an
/// estimator with an IMU cannot observe; SE(3) would also forgive a wrong vertical.
/// Each takes out what the one before it does.
enum class Alignment { kNone, kYaw, kSe3, kSim3 };

/// Numbers that an alignment takes from the truth, by which metrics name it.
[[nodiscard]] constexpr int freedoms_of(Alignment alignment) {
  constexpr std::array<int, 4> kFreedoms{0, 4, 6, 7};
  return kFreedoms[static_cast<std::size_t>(alignment)];
}

[[nodiscard]] Alignment alignment_of(double freedoms);

/// "without alignment", "after an alignment by Sim(3)", ...
[[nodiscard]] const char* alignment_text(Alignment alignment);

/// An estimated pose and the true one at the same time.
struct PosePair {
  Rigid3 estimated;  ///< world_from_camera
  Rigid3 truth;      ///< world_from_camera
};

/// truth ~ scale * rotation * estimate + translation. Orientations are rotated, not scaled.
struct Similarity {
  double scale = 1;
  Rigid3 rigid;

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return scale * (rigid.rotation() * point) + rigid.translation();
  }
  [[nodiscard]] Rigid3 operator*(const Rigid3& pose) const {
    return {rigid.rotation() * pose.rotation(), *this * pose.translation()};
  }
  /// estimate ~ inverse() * truth.
  [[nodiscard]] Similarity inverse() const {
    const Eigen::Quaterniond back = rigid.rotation().conjugate();
    return {1 / scale, {back, back * rigid.translation() / -scale}};
  }
};

/// The points moved by `aligned`.
[[nodiscard]] std::vector<Eigen::Vector3f> operator*(const Similarity& aligned,
                                                     std::span<const Eigen::Vector3f> points);

/// The poses moved by `aligned`.
[[nodiscard]] Trajectory operator*(const Similarity& aligned, const Trajectory& poses);

/// Least-squares alignment of the positions (Umeyama, PAMI 13(4), 1991):
///   min over s, R, t of sum |truth_i - (s R estimate_i + t)|^2
/// with U D V^T the singular value decomposition of the covariance of truth and estimate,
///   R = U diag(1, 1, det U det V) V^T,  s = tr(R^T covariance) / variance(estimate) (1 for SE(3)).
/// With kYaw R is the rotation about z that maximises tr(R^T covariance).
/// What of R the positions leave open is arbitrary. An estimate that stands still, or that makes
/// the best scale zero, keeps scale 1. No pairs, or Alignment::kNone: the identity.
[[nodiscard]] Similarity align_positions(std::span<const PosePair> pairs, Alignment alignment);

/// The same for poses. Where the positions leave the rotation open, the orientations decide the
/// rest by their chordal mean, the nearest rotation to sum R_truth R_estimate^T: all of it at a
/// standstill, the roll about the main direction on a path that is straight (one singular value) or
/// bends by less than ten times the error of the positions, so that they would say the roll to
/// no better than a tenth radian. With kYaw they decide where the horizontal positions say the
/// angle no better than that.
[[nodiscard]] Similarity align(std::span<const PosePair> pairs, Alignment alignment);

/// The alignment after which views that are `depth_m` > 0 deep differ least, positions and
/// orientations counting alike:
///   min over s, R, t of mean |truth_i - (s R estimate_i + t)|^2 / depth_m^2 + mean angle_i^2,
/// the angles by their chords. The positions of a short path tell the rotation far worse than its
/// orientations do. Of Sim(3) the minimum that rotation and scale in turns reach from the mean
/// rotation; a path that no positive scale fits keeps scale 1.
[[nodiscard]] Similarity align_views(std::span<const PosePair> pairs, Alignment alignment,
                                     double depth_m);

}  // namespace saccade
