#include "eval/metrics/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <optional>

#include "core/random.h"

namespace saccade {
namespace {

constexpr int kTriples = 2000;
constexpr int kRefinements = 20;
constexpr std::size_t kLeastPoints = 20;

using Indices = std::vector<std::size_t>;

Indices on_plane(std::span<const Eigen::Vector3d> points, const Indices& among, const Plane& plane,
                 double tolerance_m) {
  Indices on;
  for (const std::size_t i : among)
    if (std::abs(plane.normal.dot(points[i]) - plane.offset) <= tolerance_m) on.push_back(i);
  return on;
}

/// Total least squares: the normal is the direction of least scatter.
Plane least_squares(std::span<const Eigen::Vector3d> points, const Indices& among) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::size_t i : among) mean += points[i];
  mean /= static_cast<double>(among.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::size_t i : among) scatter += (points[i] - mean) * (points[i] - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return {normal, normal.dot(mean)};
}

std::optional<Plane> best_plane(std::span<const Eigen::Vector3d> points, const Indices& among,
                                double tolerance_m, std::uint64_t stream) {
  if (among.size() < kLeastPoints) return std::nullopt;
  const Random random(1);
  Plane best;
  std::size_t most = 0;
  for (std::uint64_t i = 0; i < kTriples; ++i) {
    const auto pick = [&](std::uint64_t k) {
      return points[among[random.below(among.size(), stream, 3 * i + k)]];
    };
    const Eigen::Vector3d a = pick(0);
    const Eigen::Vector3d normal = (pick(1) - a).cross(pick(2) - a);
    if (!(normal.norm() > tolerance_m * tolerance_m)) continue;
    const Plane plane{normal.normalized(), normal.normalized().dot(a)};
    const std::size_t count = on_plane(points, among, plane, tolerance_m).size();
    if (count > most) {
      most = count;
      best = plane;
    }
  }
  if (most < kLeastPoints) return std::nullopt;
  Indices on = on_plane(points, among, best, tolerance_m);
  for (int i = 0; i < kRefinements; ++i) {
    best = least_squares(points, on);
    Indices now = on_plane(points, among, best, tolerance_m);
    if (now == on || now.size() < kLeastPoints) break;
    on = std::move(now);
  }
  return best;
}

}  // namespace

std::vector<FittedPlane> fit_planes(std::span<const Eigen::Vector3d> points, double tolerance_m,
                                    std::size_t count) {
  Indices rest(points.size());
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = i;
  std::vector<FittedPlane> planes;
  while (planes.size() < count) {
    const auto plane = best_plane(points, rest, tolerance_m, planes.size());
    if (!plane) break;
    planes.push_back({*plane, on_plane(points, rest, *plane, tolerance_m)});
    Indices others;
    std::set_difference(rest.begin(), rest.end(), planes.back().points.begin(),
                        planes.back().points.end(), std::back_inserter(others));
    rest = std::move(others);
  }
  return planes;
}

double angle_between_deg(const Plane& a, const Plane& b) {
  return std::acos(std::min(1.0, std::abs(a.normal.dot(b.normal)))) * 180 / std::numbers::pi;
}

}  // namespace saccade
