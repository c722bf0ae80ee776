#include "simulator/scene/animation/vertex_animation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "core/check.h"

namespace saccade {
namespace {

/// So far from a jump its two sides are sampled [s].
constexpr double kAroundJump_s = 1e-9;
/// Nearer to an end of an interval a kink is there [s].
constexpr double kSameTime_s = 1e-10;
/// The first and the last pose of a loop are one where they differ by less than this part of its
/// size.
constexpr double kClosed = 1e-6;

Eigen::Vector3d between(const MeshAnimation::Vectors& from, const MeshAnimation::Vectors& to,
                        double fraction, std::uint32_t index) {
  const Eigen::Vector3d a = from[index].cast<double>();
  return a + fraction * (to[index].cast<double>() - a);
}

}  // namespace

VertexAnimation::VertexAnimation(const MeshAnimation& animation,
                                 const Eigen::Affine3d& body_from_mesh,
                                 const AnimationOptions& options)
    : times_s_(animation.times_s),
      start_s_(options.start_s),
      speed_(options.speed),
      loop_(options.loop) {
  SACCADE_CHECK(times_s_.size() >= 2 && animation.vertices.size() == times_s_.size() &&
                animation.normals.size() == times_s_.size());
  const Eigen::Matrix3d normal_matrix = body_from_mesh.linear().inverse().transpose();
  for (std::size_t k = 0; k < times_s_.size(); ++k) {
    MeshAnimation::Vectors& vertices = vertices_.emplace_back();
    vertices.reserve(animation.vertices[k].size() + 1);
    for (const Eigen::Vector3f& vertex : animation.vertices[k]) {
      vertices.emplace_back((body_from_mesh * vertex.cast<double>()).cast<float>());
      box_.extend(vertices.back());
    }
    vertices.emplace_back(Eigen::Vector3f::Zero());  // Embree reads 16 bytes of the last one
    MeshAnimation::Vectors& normals = normals_.emplace_back();
    normals.reserve(animation.normals[k].size());
    for (const Eigen::Vector3f& normal : animation.normals[k])
      normals.emplace_back((normal_matrix * normal.cast<double>()).cast<float>());
  }
  float apart = 0;
  for (std::size_t i = 0; i < vertex_count(); ++i)
    apart = std::max(apart, (vertices_.back()[i] - vertices_.front()[i]).norm());
  is_closed_ = apart <= static_cast<float>(kClosed) * box_.diagonal().norm();
}

VertexAnimation::Moment VertexAnimation::at(double t_s) const {
  const double duration_s = times_s_.back();
  double played = played_s(t_s);
  const std::size_t last = times_s_.size() - 2;
  if (played < 0) return {0, 0, 0};
  if (loop_)
    played -= duration_s * std::floor(played / duration_s);
  else if (played >= duration_s)
    return {last, 1, 0};
  const auto next = std::upper_bound(times_s_.begin(), times_s_.end(), played);
  const auto after = static_cast<std::size_t>(next - times_s_.begin());
  const std::size_t step = std::min(after == 0 ? 0 : after - 1, last);
  const double length_s = times_s_[step + 1] - times_s_[step];
  return {step, std::clamp((played - times_s_[step]) / length_s, 0.0, 1.0),
          length_s > kJump_s ? speed_ / length_s : 0};
}

Eigen::Vector3d VertexAnimation::vertex(const Moment& moment, std::uint32_t index) const {
  return between(vertices_[moment.step], vertices_[moment.step + 1], moment.fraction, index);
}

Eigen::Vector3d VertexAnimation::velocity(const Moment& moment, std::uint32_t index) const {
  return moment.per_s * (vertices_[moment.step + 1][index].cast<double>() -
                         vertices_[moment.step][index].cast<double>());
}

Eigen::Vector3d VertexAnimation::normal(const Moment& moment, std::uint32_t index) const {
  return between(normals_[moment.step], normals_[moment.step + 1], moment.fraction, index);
}

std::optional<double> VertexAnimation::first_kink_s(double from_s, double to_s) const {
  const double duration_s = times_s_.back();
  double best = std::numeric_limits<double>::infinity();
  const auto consider = [&](double t_s) {
    if (t_s > from_s + kSameTime_s) best = std::min(best, t_s);
  };
  const double first_round = std::floor(played_s(from_s) / duration_s);
  // Rounding may put the interval's start on either side of a pose: those of the rounds around it.
  for (double round = first_round - 1; round <= first_round + 1; ++round) {
    if (round < 0 || (!loop_ && round > 0)) continue;
    const double played = played_s(from_s) - round * duration_s;
    const auto near = std::lower_bound(times_s_.begin(), times_s_.end(), played);
    const auto first = near == times_s_.begin() ? near : near - 1;
    for (auto it = first; it != times_s_.end() && it < first + 3; ++it) {
      const double t_s = start_s_ + (round * duration_s + *it) / speed_;
      const bool is_end = it + 1 == times_s_.end();
      const bool is_jump =
          loop_ && !is_closed_ && (is_end || (it == times_s_.begin() && round > 0));
      consider(t_s - (is_jump ? kAroundJump_s : 0));
      consider(t_s + (is_jump ? kAroundJump_s : 0));
    }
  }
  if (!(best < to_s - kSameTime_s)) return std::nullopt;
  return best;
}

}  // namespace saccade
