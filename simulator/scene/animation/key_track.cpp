#include "simulator/scene/animation/key_track.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

std::size_t stride(const ModelTrack& track, std::size_t width) {
  return track.interpolation == KeyInterpolation::kCubic ? 3 * width : width;
}

/// The keys around a time, and where between them it is.
struct KeyInterval {
  std::size_t from, to;
  double fraction;  ///< 0 where both are one
  double length_s;
};

KeyInterval interval_at(const ModelTrack& track, double t_s) {
  const std::vector<double>& times = track.times_s;
  const auto next =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t_s) - times.begin());
  if (next == 0) return {0, 0, 0, 0};
  if (next == times.size()) return {next - 1, next - 1, 0, 0};
  const double length_s = times[next] - times[next - 1];
  return {next - 1, next, (t_s - times[next - 1]) / length_s, length_s};
}

template <int n>
Eigen::Matrix<double, n, 1> value_of(const ModelTrack& track, std::size_t key, std::size_t part) {
  return Eigen::Map<const Eigen::Matrix<double, n, 1>>(
      &track.values[key * stride(track, n) + part * n]);
}

/// Value and slopes of a cubic key, in their order.
enum CubicPart : std::size_t { kSlopeBefore, kValue, kSlopeAfter };

/// Cubic Hermite spline, or the first key's value.
template <int n>
Eigen::Matrix<double, n, 1> cubic_at(const ModelTrack& track, const KeyInterval& at) {
  const double u = at.fraction;
  const double u2 = u * u;
  const double u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * value_of<n>(track, at.from, kValue) +
         at.length_s * (u3 - 2 * u2 + u) * value_of<n>(track, at.from, kSlopeAfter) +
         (3 * u2 - 2 * u3) * value_of<n>(track, at.to, kValue) +
         at.length_s * (u3 - u2) * value_of<n>(track, at.to, kSlopeBefore);
}

Eigen::Quaterniond normalized(const Eigen::Vector4d& xyzw) {
  const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  return q.norm() > 0 ? q.normalized() : Eigen::Quaterniond::Identity();
}

}  // namespace

bool is_valid(const ModelTrack& track, std::size_t width) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  return track.values.size() == track.times_s.size() * stride(track, width) &&
         std::ranges::is_sorted(track.times_s) && std::ranges::all_of(track.times_s, is_finite) &&
         std::ranges::all_of(track.values, is_finite);
}

Eigen::Vector3d vector_at(const ModelTrack& track, double t_s) {
  const KeyInterval at = interval_at(track, t_s);
  if (track.interpolation == KeyInterpolation::kCubic) return cubic_at<3>(track, at);
  const Eigen::Vector3d from = value_of<3>(track, at.from, 0);
  if (track.interpolation == KeyInterpolation::kStep) return from;
  return from + at.fraction * (value_of<3>(track, at.to, 0) - from);
}

Eigen::Quaterniond rotation_at(const ModelTrack& track, double t_s) {
  const KeyInterval at = interval_at(track, t_s);
  if (track.interpolation == KeyInterpolation::kCubic) return normalized(cubic_at<4>(track, at));
  const Eigen::Quaterniond from = normalized(value_of<4>(track, at.from, 0));
  if (track.interpolation == KeyInterpolation::kStep) return from;
  return from.slerp(at.fraction, normalized(value_of<4>(track, at.to, 0)));
}

}  // namespace saccade
