#include "simulator/sensor/imu/imu_noise.h"

#include <cmath>

#include "core/check.h"
#include "core/random.h"

namespace saccade {
namespace {

enum class Draw : std::uint64_t { kWhite, kWalk };

/// Streams of their own, far from those of pixels.
std::uint64_t stream_of(ImuTriad triad, Draw draw, int axis) {
  constexpr std::uint64_t kImu = 0x494D55ULL << 40;
  const std::uint64_t kind =
      2 * static_cast<std::uint64_t>(triad) + static_cast<std::uint64_t>(draw);
  return kImu + 3 * kind + static_cast<std::uint64_t>(axis);
}

}  // namespace

std::vector<TriadError> triad_errors(const TriadNoise& noise, const Eigen::Vector3d& turn_on_bias,
                                     double dt_s, std::uint64_t seed, ImuTriad triad,
                                     std::size_t count) {
  SACCADE_CHECK(dt_s > 0);
  const Random random(seed);
  const double white_sigma = noise.density / std::sqrt(dt_s);
  const double walk_sigma = noise.random_walk * std::sqrt(dt_s);
  const auto draw = [&](double sigma, Draw kind, std::size_t k) -> Eigen::Vector3d {
    if (sigma == 0) return Eigen::Vector3d::Zero();
    Eigen::Vector3d v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = sigma * random.normal(stream_of(triad, kind, axis), k);
    return v;
  };
  std::vector<TriadError> errors(count);
  Eigen::Vector3d bias = turn_on_bias;
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0) bias += draw(walk_sigma, Draw::kWalk, k);
    errors[k] = {bias, draw(white_sigma, Draw::kWhite, k)};
  }
  return errors;
}

}  // namespace saccade
