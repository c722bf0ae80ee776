#include "estimator/odometry/start/flow_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Dense>

#include "core/check.h"
#include "core/median.h"
#include "core/process/parallel.h"
#include "core/random.h"

namespace saccade {
namespace {

constexpr double kNoOutliers = 1e300;
constexpr int kDirections = 400;       ///< of a sphere: about 6 degrees apart
constexpr int kReweightings = 3;       ///< of signs and weights, for each of these
constexpr std::size_t kStarts = 8;     ///< best directions that are refined
constexpr double kStartsApart = 0.95;  ///< cosine of the angle between them, at most
constexpr int kSteps = 12;             ///< of Levenberg and Marquardt
constexpr std::size_t kResamples = 40;
constexpr double kAgreeing = 0.8;       ///< share of the resamples whose largest angle is stated
constexpr double kModesApart_deg = 25;  ///< closer ones a refinement of the path brings together
constexpr int kLeastOfMode = 2;         ///< resamples that lead to it: one may do so by chance

Eigen::Matrix<double, 2, 3> by_velocity(const Eigen::Vector2d& at) {
  Eigen::Matrix<double, 2, 3> a;
  a << -1, 0, at.x(), 0, -1, at.y();
  return a;
}

Eigen::Matrix<double, 2, 3> by_rate(const Eigen::Vector2d& at) {
  const double x = at.x(), y = at.y();
  Eigen::Matrix<double, 2, 3> b;
  b << x * y, -1 - x * x, y, 1 + y * y, -x * y, -x;
  return b;
}

struct Tile {
  Eigen::Matrix<double, 2, 3> a, b;
  Eigen::Vector2d flow;
  Eigen::Matrix2d information;
  Eigen::Matrix2d root;  ///< its Cholesky factor: information = root' root
  double count = 1;      ///< how often it was drawn
};

struct Solution {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  std::vector<double> inverse_depth;
  double cost = 0;
};

/// The rate and the depths for one direction of the velocity; squared residuals r count as
/// r / (1 + r / outlier).
Solution solve(const std::vector<Tile>& tiles, const Eigen::Vector3d& direction, double outlier) {
  Solution solution;
  solution.inverse_depth.assign(tiles.size(), 1);
  std::vector<double> weights(tiles.size(), 1);
  for (int i = 0; i < kReweightings; ++i) {
    Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < tiles.size(); ++k) {
      const Tile& tile = tiles[k];
      Eigen::Matrix2d m = tile.information;
      const Eigen::Vector2d a = tile.a * direction;
      const Eigen::Vector2d ha = tile.information * a;
      // A tile at infinity has no depth to adapt.
      if (solution.inverse_depth[k] > 0) m -= ha * ha.transpose() / std::max(a.dot(ha), 1e-12);
      const double weight = tile.count * weights[k];
      normal += weight * tile.b.transpose() * m * tile.b;
      right += weight * tile.b.transpose() * m * tile.flow;
    }
    solution.rate = normal.ldlt().solve(right);
    solution.cost = 0;
    for (std::size_t k = 0; k < tiles.size(); ++k) {
      const Tile& tile = tiles[k];
      const Eigen::Vector2d a = tile.a * direction;
      const Eigen::Vector2d rest = tile.flow - tile.b * solution.rate;
      const Eigen::Vector2d ha = tile.information * a;
      solution.inverse_depth[k] = std::max(0.0, ha.dot(rest) / std::max(a.dot(ha), 1e-12));
      const Eigen::Vector2d residual = rest - solution.inverse_depth[k] * a;
      const double square = residual.dot(tile.information * residual);
      weights[k] = 1 / ((1 + square / outlier) * (1 + square / outlier));
      solution.cost += tile.count * square / (1 + square / outlier);
    }
  }
  return solution;
}

/// Direction and rate.
struct Motion {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ(), rate = Eigen::Vector3d::Zero();

  /// Turned by the first two unknowns across itself, the rate changed by the others.
  [[nodiscard]] Motion moved(const Eigen::Matrix<double, 5, 1>& step) const {
    const Eigen::Vector3d across = direction.unitOrthogonal();
    return {(direction + step[0] * across + step[1] * direction.cross(across)).normalized(),
            rate + step.tail<3>()};
  }
};

/// Whitened residual of a tile at its best depth, drawn in by its robust weight.
Eigen::Vector2d residual_of(const Tile& tile, const Motion& motion, double outlier) {
  const Eigen::Vector2d a = tile.a * motion.direction;
  const Eigen::Vector2d rest = tile.flow - tile.b * motion.rate;
  const Eigen::Vector2d ha = tile.information * a;
  const double inverse_depth = std::max(0.0, ha.dot(rest) / std::max(a.dot(ha), 1e-12));
  const Eigen::Vector2d residual = tile.root * (rest - inverse_depth * a);
  return std::sqrt(tile.count / (1 + residual.squaredNorm() / outlier)) * residual;
}

double cost_of(const std::vector<Tile>& tiles, const Motion& motion, double outlier) {
  double cost = 0;
  for (const Tile& tile : tiles) cost += residual_of(tile, motion, outlier).squaredNorm();
  return cost;
}

/// The nearest minimum, and its cost.
std::pair<Motion, double> refined(const std::vector<Tile>& tiles, Motion motion, double outlier) {
  constexpr double kDifference = 1e-6;
  double cost = cost_of(tiles, motion, outlier), damping = 1e-3;
  for (int i = 0; i < kSteps && damping < 1e6; ++i) {
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> gradient = Eigen::Matrix<double, 5, 1>::Zero();
    std::array<Motion, 5> aside;
    for (int k = 0; k < 5; ++k)
      aside[static_cast<std::size_t>(k)] =
          motion.moved(kDifference * Eigen::Matrix<double, 5, 1>::Unit(k));
    for (const Tile& tile : tiles) {
      if (tile.count == 0) continue;
      const Eigen::Vector2d residual = residual_of(tile, motion, outlier);
      Eigen::Matrix<double, 2, 5> jacobian;
      for (int k = 0; k < 5; ++k)
        jacobian.col(k) =
            (residual_of(tile, aside[static_cast<std::size_t>(k)], outlier) - residual) /
            kDifference;
      normal += jacobian.transpose() * jacobian;
      gradient += jacobian.transpose() * residual;
    }
    while (damping < 1e6) {
      Eigen::Matrix<double, 5, 5> damped = normal;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-12;
      const Motion next = motion.moved(damped.ldlt().solve(-gradient));
      const double next_cost = cost_of(tiles, next, outlier);
      if (next_cost < cost) {
        motion = next, cost = next_cost, damping /= 10;
        break;
      }
      damping *= 10;
    }
  }
  return {motion, cost};
}

/// Directions all over the sphere with the lowest costs, well apart, each with its rate.
std::vector<Motion> starts_of(const std::vector<Tile>& tiles, double outlier) {
  std::vector<std::pair<double, Motion>> all;
  const double golden = M_PI * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, radius = std::sqrt(1 - z * z);
    const Eigen::Vector3d direction(radius * std::cos(golden * i), radius * std::sin(golden * i),
                                    z);
    const Solution solution = solve(tiles, direction, outlier);
    all.push_back({solution.cost, {direction, solution.rate}});
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Motion> starts;
  for (const std::pair<double, Motion>& candidate : all) {
    if (starts.size() == kStarts) break;
    const Motion& motion = candidate.second;
    const bool is_near = std::any_of(starts.begin(), starts.end(), [&](const Motion& other) {
      return other.direction.dot(motion.direction) > kStartsApart;
    });
    if (!is_near) starts.push_back(motion);
  }
  return starts;
}

Motion best_of(const std::vector<Tile>& tiles, const std::vector<Motion>& starts, double outlier) {
  Motion best;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Motion& start : starts) {
    const auto [motion, cost] = refined(tiles, start, outlier);
    if (cost < lowest) lowest = cost, best = motion;
  }
  return best;
}

/// Squared residual beyond which a tile is an outlier: the scale of the information is unknown.
double outlier_of(const std::vector<Tile>& tiles, const Motion& motion) {
  std::vector<double> squares;
  squares.reserve(tiles.size());
  for (const Tile& tile : tiles)
    squares.push_back(residual_of(tile, motion, kNoOutliers).squaredNorm());
  return std::max(1e-12, 9 * median(std::move(squares)));
}

/// What tiles drawn with replacement lead to.
std::vector<Motion> resampled(const std::vector<Tile>& tiles, const std::vector<Motion>& starts,
                              const Motion& best, double outlier) {
  std::vector<Motion> all = starts;
  all.push_back(best);
  const Random random(1);
  std::vector<Motion> found(kResamples);
  parallel_for(kResamples, [&](std::size_t i) {
    std::vector<Tile> drawn = tiles;
    for (Tile& tile : drawn) tile.count = 0;
    for (std::size_t k = 0; k < tiles.size(); ++k) {
      const auto index =
          static_cast<std::size_t>(random.uniform(i, k) * static_cast<double>(tiles.size()));
      drawn[std::min(tiles.size() - 1, index)].count += 1;
    }
    found[i] = best_of(drawn, all, outlier);
  });
  return found;
}

/// How far they lead away from the best direction.
double spread_deg(const std::vector<Motion>& resamples, const Motion& best) {
  std::vector<double> angles;
  angles.reserve(resamples.size());
  for (const Motion& motion : resamples)
    angles.push_back(angle_deg(best.direction, motion.direction));
  std::sort(angles.begin(), angles.end());
  return angles[static_cast<std::size_t>(kAgreeing * static_cast<double>(angles.size()))];
}

/// Directions apart from the best and from each other that resamples lead to.
std::vector<Motion> modes_of(const std::vector<Motion>& resamples, const Motion& best) {
  struct Mode {
    Motion motion;
    int count = 0;
  };
  std::vector<Mode> modes = {{best}};
  for (const Motion& motion : resamples) {
    const auto same = std::find_if(modes.begin(), modes.end(), [&](const Mode& mode) {
      return angle_deg(mode.motion.direction, motion.direction) < kModesApart_deg;
    });
    if (same == modes.end())
      modes.push_back({motion, 1});
    else
      ++same->count;
  }
  std::stable_sort(modes.begin() + 1, modes.end(),
                   [](const Mode& a, const Mode& b) { return a.count > b.count; });
  std::vector<Motion> motions;
  for (std::size_t i = 1; i < modes.size(); ++i)
    if (modes[i].count >= kLeastOfMode) motions.push_back(modes[i].motion);
  return motions;
}

/// With every tile at infinity.
Eigen::Vector3d rotation_of(const std::vector<Tile>& tiles, double outlier) {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (int i = 0; i <= kReweightings; ++i) {
    Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Tile& tile : tiles) {
      const Eigen::Vector2d residual = tile.flow - tile.b * rate;
      const double scaled = i == 0 ? 0 : residual.dot(tile.information * residual) / outlier;
      const double weight = 1 / ((1 + scaled) * (1 + scaled));
      normal += weight * tile.b.transpose() * tile.information * tile.b;
      right += weight * tile.b.transpose() * tile.information * tile.flow;
    }
    rate = normal.ldlt().solve(right);
  }
  return rate;
}

FlowMotion motion_of(const std::vector<Tile>& tiles, const Motion& motion) {
  FlowMotion found;
  found.rate = motion.rate;
  for (const Tile& tile : tiles) {
    const Eigen::Vector2d a = tile.a * motion.direction, ha = tile.information * a;
    found.inverse_depth.push_back(
        std::max(0.0, ha.dot(tile.flow - tile.b * motion.rate) / std::max(a.dot(ha), 1e-12)));
  }
  const double typical = std::max(1e-9, median(found.inverse_depth));
  found.velocity = typical * motion.direction;
  for (double& inverse_depth : found.inverse_depth) inverse_depth /= typical;
  return found;
}

}  // namespace

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

FlowMotion fit_motion(std::span<const TileFlow> flows, bool is_spread_asked) {
  SACCADE_CHECK(flows.size() >= kLeastTiles);
  std::vector<Tile> tiles;
  for (const TileFlow& flow : flows)
    tiles.push_back({by_velocity(flow.ray), by_rate(flow.ray), flow.flow, flow.information,
                     Eigen::LLT<Eigen::Matrix2d>(flow.information).matrixU()});
  const Motion rough = best_of(tiles, starts_of(tiles, kNoOutliers), kNoOutliers);
  const double outlier = outlier_of(tiles, rough);
  std::vector<Motion> starts = starts_of(tiles, outlier);
  starts.push_back(rough);
  const Motion best = best_of(tiles, starts, outlier);
  FlowMotion found = motion_of(tiles, best);
  found.rotation = rotation_of(tiles, outlier);
  if (is_spread_asked) {
    const std::vector<Motion> resamples = resampled(tiles, starts, best, outlier);
    found.direction_deg = spread_deg(resamples, best);
    for (const Motion& mode : modes_of(resamples, best))
      found.others.push_back(motion_of(tiles, mode));
  }
  return found;
}

}  // namespace saccade
