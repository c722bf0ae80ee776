#include "simulator/motion/spline_table.h"

#include "core/check.h"

namespace saccade {
namespace {

constexpr double kTableTolerance = 1e-9;
constexpr std::size_t kFewestPieces = 4;
constexpr double kShortestPiece_s = 5e-6;

struct Knot {
  Eigen::Matrix<double, 3, 4> value;
  Eigen::Matrix<double, 3, 4> rate;  ///< [1/s]
};

Knot knot_at(const Spline& spline, double t_s) {
  const SplineState state = spline.state(t_s);
  const Eigen::Matrix3d rotation = state.world_from_body.rotation_matrix();
  Knot knot;
  knot.value << rotation, state.world_from_body.translation();
  knot.rate << rotation * skew(state.angular_velocity_in_body), state.velocity_in_world;
  return knot;
}

}  // namespace

SplineTable::SplineTable(const Spline& world_from_body, double from_s, double to_s)
    : from_s_(from_s), length_s_(to_s - from_s) {
  SACCADE_CHECK(to_s > from_s);
  std::size_t count = kFewestPieces;
  fill(world_from_body, count);
  while (largest_error(world_from_body) > kTableTolerance &&
         length_s_ > kShortestPiece_s * static_cast<double>(2 * count))
    fill(world_from_body, count *= 2);
}

void SplineTable::fill(const Spline& spline, std::size_t count) {
  const double piece_s = length_s_ / static_cast<double>(count);
  pieces_per_s_ = 1 / piece_s;
  pieces_.clear();
  Knot a = knot_at(spline, from_s_);
  for (std::size_t i = 1; i <= count; ++i) {
    const Knot b = knot_at(spline, from_s_ + piece_s * static_cast<double>(i));
    const Entries chord = b.value - a.value;
    const Entries first = piece_s * a.rate;
    const Entries second = piece_s * b.rate;
    pieces_.push_back({a.value, first, 3 * chord - 2 * first - second, first + second - 2 * chord});
    a = b;
  }
}

double SplineTable::largest_error(const Spline& spline) const {
  double largest = 0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double t = from_s_ + (static_cast<double>(i) + 0.5) / pieces_per_s_;
    const Rigid3 pose = spline.pose(t);
    const CameraFrame frame = at(t);
    largest = std::max({largest, (frame.rotation - pose.rotation_matrix()).cwiseAbs().maxCoeff(),
                        (frame.position - pose.translation()).cwiseAbs().maxCoeff()});
  }
  return largest;
}

}  // namespace saccade
