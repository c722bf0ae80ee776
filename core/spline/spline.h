#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/rigid3.h"
#include "core/spline/segment.h"
#include "core/trajectory.h"

namespace saccade {

/// Pose and analytic derivatives at one instant.
struct SplineState {
  Rigid3 world_from_body;
  Eigen::Vector3d velocity_in_world;             ///< [m/s]
  Eigen::Vector3d acceleration_in_world;         ///< [m/s^2], without gravity
  Eigen::Vector3d angular_velocity_in_body;      ///< [rad/s]
  Eigen::Vector3d angular_acceleration_in_body;  ///< [rad/s^2]

  /// The state of a frame fixed to the body, r from the body's origin to the frame's, both in the
  /// body:
  ///   v_frame = v + R (w x r),   a_frame = a + R (alpha x r + w x (w x r)),
  /// and the angular rates in the frame's axes.
  [[nodiscard]] SplineState attached(const Rigid3& body_from_frame) const;
};

/// Cumulative cubic B-spline on R^3 x SO(3), C2, knots at any strictly increasing times:
///   p(t) = p_0 + sum_j B_j(t) (p_j - p_{j-1}),   R(t) = R_0 prod_j Exp(B_j(t) Log(R_{j-1}^-1 R_j))
/// over the four control poses of a segment (Kim et al., SIGGRAPH 1995; Sommer et al., CVPR 2020).
/// Immutable and thread-safe. Outside [start_s, end_s] the time is clamped.
class Spline {
 public:
  /// Passes through every pose at its time (to 1e-6 m and 1e-6 rad); knots at the poses' times,
  /// natural ends (no acceleration there). At least 2 poses, times strictly increasing. Consecutive
  /// rotations may be 150 degrees apart and more about changing axes where times are evenly spaced;
  /// throws InputError where no spline through them is found (large rotations within very uneven
  /// times).
  [[nodiscard]] static Spline interpolate(std::span<const StampedPose> poses);

  /// Least-squares fit with uniform knots `knot_spacing_s` apart (rounded so that whole segments
  /// fill the poses' span), for recorded motion. Where poses are missing the motion is extrapolated
  /// at constant velocity. At least 2 poses, times strictly increasing. Throws InputError if the
  /// rotations do not converge.
  [[nodiscard]] static Spline smooth(std::span<const StampedPose> poses, double knot_spacing_s);

  /// Uniform spline from control poses: segment i starts at start_s + i * knot_spacing_s and uses
  /// control poses i..i+3. At least 4 control poses.
  [[nodiscard]] static Spline from_control_poses(std::span<const Rigid3> control_poses,
                                                 double start_s, double knot_spacing_s);

  /// The piece [from_s, from_s + duration_s] of the same motion, its time counted from from_s. The
  /// piece lies within [start_s, end_s] (contract) and lasts longer than 0.
  [[nodiscard]] Spline cut(double from_s, double duration_s) const;

  /// The motion of a frame fixed to the moving body (a rig's second camera, an IMU): pose(t) is
  /// world_from_body(t) * body_from_frame, with all derivatives. May be applied repeatedly.
  [[nodiscard]] Spline attached(const Rigid3& body_from_frame) const;

  [[nodiscard]] double start_s() const { return start_s_; }
  [[nodiscard]] double end_s() const { return end_s_; }
  [[nodiscard]] std::size_t segment_count() const { return segments_.size(); }

  [[nodiscard]] Rigid3 pose(double t_s) const;
  [[nodiscard]] SplineState state(double t_s) const;

 private:
  Spline(std::vector<SplineSegment> segments, double start_s, double end_s);
  [[nodiscard]] std::size_t bucket_of(double t_s) const;
  [[nodiscard]] const SplineSegment& segment_at(double t_s) const;
  [[nodiscard]] double clamped(double t_s) const;
  [[nodiscard]] SplineState body_state(double t_s) const;

  std::vector<SplineSegment> segments_;
  double start_s_;
  double end_s_;
  double buckets_per_s_;
  /// Per bucket of time the last segment that starts in an earlier bucket, so that a look-up
  /// compares a few neighbours only, however uneven the knots.
  std::vector<std::uint32_t> buckets_;
  std::optional<Rigid3> body_from_frame_;  ///< none: the body's own frame
};

}  // namespace saccade
