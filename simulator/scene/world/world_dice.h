#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "core/random.h"

namespace saccade {

/// Draws in a row from one stream of a world's seed. Each part of a world has a stream of its own,
/// so that a change of one leaves the others as they are.
class WorldDice {
 public:
  WorldDice(std::uint64_t seed, std::uint64_t stream) : random_(seed), stream_(stream) {}

  double uniform() { return random_.uniform(stream_, next_++); }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  double log_between(double low, double high) { return low * std::pow(high / low, uniform()); }
  /// Both ends included.
  int integer(int low, int high) {
    const auto count = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<int>(random_.below(count, stream_, next_++));
  }
  /// Each part between those of both.
  Eigen::Vector3d vector(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = between(low[i], high[i]);
    return v;
  }
  bool chance(double probability) { return uniform() < probability; }
  std::uint64_t seed() { return random_.below(1ULL << 31, stream_, next_++); }

  /// Uniform on the sphere, by rejection.
  Eigen::Vector3d direction() {
    while (true) {
      const Eigen::Vector3d v = vector({-1, -1, -1}, {1, 1, 1});
      if (v.squaredNorm() <= 1 && v.squaredNorm() > 0.01) return v.normalized();
    }
  }

  /// Uniform over all rotations: a direction in four dimensions as a quaternion.
  Eigen::Matrix3d rotation() {
    while (true) {
      Eigen::Vector4d v;
      for (int i = 0; i < 4; ++i) v[i] = between(-1, 1);
      if (v.squaredNorm() <= 1 && v.squaredNorm() > 0.01)
        return Eigen::Quaterniond(v.normalized()).toRotationMatrix();
    }
  }

 private:
  Random random_;
  std::uint64_t stream_;
  std::uint64_t next_ = 0;
};

/// The rotation about +z that turns +x to (1, slope).
[[nodiscard]] inline Eigen::Matrix3d turn_by_slope(double slope) {
  const Eigen::Vector2d x = Eigen::Vector2d(1, slope).normalized();
  Eigen::Matrix3d turn;
  turn << x.x(), -x.y(), 0, x.y(), x.x(), 0, 0, 0, 1;
  return turn;
}

}  // namespace saccade
