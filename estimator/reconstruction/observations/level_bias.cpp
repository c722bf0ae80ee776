#include "estimator/reconstruction/observations/level_bias.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// Larger than most of what is seen, so that tiles change by themselves.
constexpr int kBiasTile_px = 16;
/// Of the improvement of the sum of squares by the two shares, in variances of a tile: about 2 by chance where
/// tiles are independent. Neighbours are not quite: up to 10 in a dozen worlds of ideal pixels.
constexpr double kChance = 20;

}  // namespace

LevelBiasFit::LevelBiasFit(SensorSize size)
    : size_(size),
      tiles_((size.width - 1) / kBiasTile_px + 1, (size.height - 1) / kBiasTile_px + 1) {}

LevelBiasFit::Tile& LevelBiasFit::tile_of(const Event& event) {
  return tiles_(event.x / kBiasTile_px, event.y / kBiasTile_px);
}

void LevelBiasFit::add_first(const Event& event, float change) {
  Tile& tile = tile_of(event);
  tile.net += static_cast<double>(change);
  tile.size += static_cast<double>(std::abs(change));
  ++tile.firsts;
  first_change_ += static_cast<double>(change);
  ++firsts_;
}

void LevelBiasFit::add(const Event& event, float change, TimeNs interval_ns, int polarity_before) {
  Tile& tile = tile_of(event);
  const auto size = static_cast<double>(std::abs(change));
  tile.net += static_cast<double>(change);
  tile.size += size;
  tile.quick += size * static_cast<double>(LevelBias::quickness(interval_ns));
  add_rest(interval_ns, polarity_before);
}

void LevelBiasFit::add_rest(TimeNs interval_ns, int polarity) {
  polarity_ns_ += static_cast<double>(polarity) * static_cast<double>(interval_ns);
  time_ns_ += static_cast<double>(interval_ns);
}

LevelBias LevelBiasFit::found() const {
  LevelBias bias;
  if (firsts_ == 0) return bias;
  const double start = first_change_ / firsts_;
  bias.start = static_cast<float>(start);
  if (time_ns_ > 0) bias.last_polarity = static_cast<float>(polarity_ns_ / time_ns_);
  // Least squares of the net change per pixel; tiles at the border are smaller.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0;
  for (int y = 0; y < tiles_.height(); ++y)
    for (int x = 0; x < tiles_.width(); ++x) {
      const Tile& tile = tiles_(x, y);
      const int pixels = std::min(kBiasTile_px, size_.width - x * kBiasTile_px) *
                         std::min(kBiasTile_px, size_.height - y * kBiasTile_px);
      const double weight = 1.0 / pixels;
      const double net = tile.net - tile.firsts * start;
      const Eigen::Vector2d row(tile.size, tile.quick);
      normal += weight * row * row.transpose();
      right += weight * net * row;
      squares += weight * net * net;
    }
  const auto free = static_cast<double>(tiles_.size()) - 2;
  const Eigen::LDLT<Eigen::Matrix2d> solver(normal);
  // Without quick events the two are not told apart.
  if (free < 1 || solver.info() != Eigen::Success || !(solver.rcond() > 1e-9)) return bias;
  const Eigen::Vector2d shares = solver.solve(right);
  const double explained = shares.dot(right);
  const double variance = (squares - explained) / free;
  if (!(explained > kChance * variance)) return bias;
  const double taken = 1 - kChance * variance / explained;
  bias.per_change = static_cast<float>(taken * shares[0]);
  bias.per_quick_change = static_cast<float>(taken * shares[1]);
  return bias;
}

}  // namespace saccade
