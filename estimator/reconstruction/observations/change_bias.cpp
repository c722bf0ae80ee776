#include "estimator/reconstruction/observations/change_bias.h"

#include <Eigen/Dense>

namespace saccade {
namespace {

/// Larger than most of what is seen, so that tiles change by themselves.
constexpr int kBiasTile_px = 16;
/// Of the squared size of what is found, in its variance by chance: 1 for each unknown where tiles are independent, 9 at three
/// standard deviations. Neighbours are not quite independent: of two unknowns it was up to 10 in a dozen worlds of ideal pixels.
constexpr double kChance = 20;

/// 0 where it may be chance, 1 where it is far from it.
double taken(double square, double variance) {
  return square > kChance * variance ? 1 - kChance * variance / square : 0;
}

}  // namespace

ChangeBiasFit::ChangeBiasFit(SensorSize size)
    : tiles_((size.width - 1) / kBiasTile_px + 1, (size.height - 1) / kBiasTile_px + 1) {
  for (int y = 0; y < tiles_.height(); ++y)
    for (int x = 0; x < tiles_.width(); ++x)
      tiles_(x, y).pixels = std::min(kBiasTile_px, size.width - x * kBiasTile_px) *
                            std::min(kBiasTile_px, size.height - y * kBiasTile_px);
}

ChangeBiasFit::Tile& ChangeBiasFit::tile_of(int x, int y) {
  return tiles_(x / kBiasTile_px, y / kBiasTile_px);
}

void ChangeBiasFit::add_first(const Event& event, float change) {
  Tile& tile = tile_of(event.x, event.y);
  tile.first_change += static_cast<double>(change);
  ++tile.firsts;
}

void ChangeBiasFit::add(const Event& event, float change, TimeNs interval_ns, int polarity_before) {
  Tile& tile = tile_of(event.x, event.y);
  const auto size = static_cast<double>(std::abs(change));
  tile.net += static_cast<double>(change);
  tile.size += size;
  tile.quick += size * static_cast<double>(ChangeBias::quickness(interval_ns));
  add_rest(event.x, event.y, interval_ns, polarity_before);
}

void ChangeBiasFit::add_rest(int x, int y, TimeNs interval_ns, int polarity) {
  Tile& tile = tile_of(x, y);
  tile.polarity_ns += static_cast<double>(polarity) * static_cast<double>(interval_ns);
  tile.time_ns += static_cast<double>(interval_ns);
}

double ChangeBiasFit::mean(double Tile::*sum, double Tile::*count) const {
  double sums = 0, counts = 0;
  for (const Tile& tile : tiles_.pixels()) {
    sums += tile.*sum;
    counts += tile.*count;
  }
  if (!(counts > 0)) return 0;
  const double mean = sums / counts;
  double squares = 0, squared_counts = 0;
  for (const Tile& tile : tiles_.pixels()) {
    const double rest = tile.*sum - mean * (tile.*count);
    squares += rest * rest;
    squared_counts += tile.*count * tile.*count;
  }
  // A few tiles see one edge, by which the sensor is not judged.
  constexpr double kLeastTiles = 8;
  if (counts * counts < kLeastTiles * squared_counts) return 0;
  return mean * taken(mean * mean, squares / (counts * counts));
}

ChangeBias ChangeBiasFit::found() const {
  ChangeBias bias;
  const double start = mean(&Tile::first_change, &Tile::firsts);
  bias.start = static_cast<float>(start);
  bias.last_polarity = static_cast<float>(mean(&Tile::polarity_ns, &Tile::time_ns));
  // Least squares of the net change per pixel, by one fraction and by two. The net change has that of the first events, too, but
  // for their mean: after a first rise a fall is more likely.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0;
  for (const Tile& tile : tiles_.pixels()) {
    const double net = tile.net + tile.first_change - tile.firsts * start;
    const Eigen::Vector2d row(tile.size, tile.quick);
    normal += row * row.transpose() / tile.pixels;
    right += net * row / tile.pixels;
    squares += net * net / tile.pixels;
  }
  const auto free = static_cast<double>(tiles_.size()) - 2;
  if (free < 2 || !(normal(0, 0) > 0)) return bias;
  const double one = right[0] / normal(0, 0);
  const double explained_by_one = one * right[0];
  // Where events are equally quick everywhere the two are not told apart.
  constexpr double kLeastSquaredSine = 1e-3;
  if (normal.determinant() > kLeastSquaredSine * normal(0, 0) * normal(1, 1)) {
    const Eigen::Vector2d two = normal.inverse() * right;
    const double explained = two.dot(right);
    const double variance = (squares - explained) / free;
    if (explained - explained_by_one > kChance * variance) {
      const double fraction = taken(explained, variance);
      bias.fraction = static_cast<float>(fraction * two[0]);
      bias.quick_fraction = static_cast<float>(fraction * two[1]);
      return bias;
    }
  }
  bias.fraction =
      static_cast<float>(one * taken(explained_by_one, (squares - explained_by_one) / free));
  return bias;
}

}  // namespace saccade
