#include "core/spline/spline.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {

SplineState SplineState::attached(const Rigid3& body_from_frame) const {
  const Eigen::Quaterniond& world_from_body_rotation = world_from_body.rotation();
  const Eigen::Quaterniond frame_from_body = body_from_frame.rotation().conjugate();
  const Eigen::Vector3d& r = body_from_frame.translation();
  const Eigen::Vector3d& w = angular_velocity_in_body;
  SplineState frame;
  frame.world_from_body = world_from_body * body_from_frame;
  frame.velocity_in_world = velocity_in_world + world_from_body_rotation * w.cross(r);
  frame.acceleration_in_world =
      acceleration_in_world +
      world_from_body_rotation * (angular_acceleration_in_body.cross(r) + w.cross(w.cross(r)));
  frame.angular_velocity_in_body = frame_from_body * w;
  frame.angular_acceleration_in_body = frame_from_body * angular_acceleration_in_body;
  return frame;
}

Spline::Spline(std::vector<SplineSegment> segments, double start_s, double end_s)
    : segments_(std::move(segments)), start_s_(start_s), end_s_(end_s) {
  SACCADE_CHECK(!segments_.empty() && end_s_ > start_s_);
  buckets_per_s_ = static_cast<double>(segments_.size()) / (end_s_ - start_s_);
  buckets_.assign(bucket_of(end_s_) + 2, 0);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const std::size_t later = bucket_of(std::max(segments_[i].start_s, start_s_)) + 1;
    if (later < buckets_.size()) buckets_[later] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t b = 1; b < buckets_.size(); ++b) {
    buckets_[b] = std::max(buckets_[b], buckets_[b - 1]);
  }
}

std::size_t Spline::bucket_of(double t_s) const {
  return static_cast<std::size_t>((t_s - start_s_) * buckets_per_s_);
}

double Spline::clamped(double t_s) const {
  // Written so that NaN becomes the start.
  if (!(t_s > start_s_)) return start_s_;
  return t_s < end_s_ ? t_s : end_s_;
}

const SplineSegment& Spline::segment_at(double t_s) const {
  const std::size_t bucket = bucket_of(t_s);
  std::size_t low = buckets_[bucket];
  std::size_t high = buckets_[bucket + 1];
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (segments_[middle].start_s <= t_s) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return segments_[low];
}

Rigid3 Spline::pose(double t_s) const {
  const double t = clamped(t_s);
  const SplineSegment& s = segment_at(t);
  const double u = (t - s.start_s) * s.inverse_length;
  Eigen::Quaterniond e[3];
  s.factors(s.basis.value(u), e);
  const Eigen::Vector3d position =
      s.position.col(0) + u * (s.position.col(1) + u * (s.position.col(2) + u * s.position.col(3)));
  const Rigid3 world_from_body((s.first_rotation * e[0]) * (e[1] * e[2]), position);
  return body_from_frame_ ? world_from_body * *body_from_frame_ : world_from_body;
}

SplineState Spline::state(double t_s) const {
  const SplineState body = body_state(t_s);
  return body_from_frame_ ? body.attached(*body_from_frame_) : body;
}

SplineState Spline::body_state(double t_s) const {
  const double t = clamped(t_s);
  const SplineSegment& s = segment_at(t);
  const double u = (t - s.start_s) * s.inverse_length;
  const double rate = s.inverse_length;
  Eigen::Quaterniond e[3];
  s.factors(s.basis.value(u), e);
  const Eigen::Array4d db = rate * s.basis.first(u);
  const Eigen::Array4d ddb = rate * rate * s.basis.second(u);
  // Sommer et al. 2020, eqs. 38-41, from the first factor to the last.
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  Eigen::Vector3d dw = Eigen::Vector3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const Eigen::Vector3d increment = 2 * s.half_increments.col(j);
    const Eigen::Quaterniond back = e[j].conjugate();
    w = back * w + db[j] * increment;
    dw = back * dw + db[j] * w.cross(increment) + ddb[j] * increment;
  }
  SplineState state;
  const auto& p = s.position;
  state.world_from_body = {(s.first_rotation * e[0]) * (e[1] * e[2]),
                           p.col(0) + u * (p.col(1) + u * (p.col(2) + u * p.col(3)))};
  state.velocity_in_world = rate * (p.col(1) + u * (2 * p.col(2) + 3 * u * p.col(3)));
  state.acceleration_in_world = rate * rate * (2 * p.col(2) + 6 * u * p.col(3));
  state.angular_velocity_in_body = w;
  state.angular_acceleration_in_body = dw;
  return state;
}

Spline Spline::cut(double from_s, double duration_s) const {
  // Sums of rounded times may pass the ends by a hair.
  const double tolerance = 1e-9 * (1 + std::abs(end_s_));
  SACCADE_CHECK(duration_s > 0 && from_s >= start_s_ - tolerance &&
                from_s + duration_s <= end_s_ + tolerance);
  std::vector<SplineSegment> segments;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const bool over = i + 1 < segments_.size() && segments_[i + 1].start_s <= from_s;
    if (over || (!segments.empty() && segments_[i].start_s >= from_s + duration_s)) continue;
    segments.push_back(segments_[i]);
    segments.back().start_s -= from_s;
  }
  Spline piece(std::move(segments), 0, duration_s);
  piece.body_from_frame_ = body_from_frame_;
  return piece;
}

Spline Spline::attached(const Rigid3& body_from_frame) const {
  Spline motion = *this;
  motion.body_from_frame_ =
      body_from_frame_ ? *body_from_frame_ * body_from_frame : body_from_frame;
  return motion;
}

Spline Spline::from_control_poses(std::span<const Rigid3> control_poses, double start_s,
                                  double knot_spacing_s) {
  SACCADE_CHECK(control_poses.size() >= 4 && knot_spacing_s > 0);
  const CumulativeBasis basis = bases_between(std::vector<double>{0, 1}).front();
  const std::size_t count = control_poses.size() - 3;
  std::vector<SplineSegment> segments;
  segments.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Matrix3d steps, increments;
    for (int j = 0; j < 3; ++j) {
      const Rigid3& a = control_poses[i + static_cast<std::size_t>(j)];
      const Rigid3& b = control_poses[i + static_cast<std::size_t>(j) + 1];
      steps.col(j) = b.translation() - a.translation();
      increments.col(j) = so3_log(a.rotation().conjugate() * b.rotation());
    }
    segments.emplace_back(start_s + static_cast<double>(i) * knot_spacing_s, knot_spacing_s, basis,
                          control_poses[i].translation(), steps, control_poses[i].rotation(),
                          increments);
  }
  return {std::move(segments), start_s, start_s + static_cast<double>(count) * knot_spacing_s};
}

}  // namespace saccade
