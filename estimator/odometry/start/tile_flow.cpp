#include "estimator/odometry/start/tile_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

namespace saccade {
namespace {

/// Across the sensor: a tile holds edges of several directions, yet hardly a change of depth.
constexpr int kColumns = 8;
constexpr std::size_t kLeastEvents = 150;
constexpr int kSearch_px = 8;  ///< of displacement over the window, to each side
constexpr int kCoarseStep_px = 2;
constexpr double kFineStep_px = 0.5;  ///< between the values whose parabola gives the curvature
constexpr int kFineSteps = 2;         ///< to each side
constexpr int kMargin_px = kSearch_px / 2 + 2;  ///< half of the window's displacement

/// Events of a tile: where the rough motion warps them to in the middle of the window, from the
/// tile's corner, and when they fired.
struct TileEvents {
  std::vector<float> x_px, y_px;
  std::vector<float> time;  ///< since the middle, in windows: -0.5 .. 0.5
};

/// log of the sum of squares of the smoothed image, the events displaced by -`displacement` * time.
class TileContrast {
 public:
  explicit TileContrast(int tile_px)
      : side_(tile_px + 2 * kMargin_px),
        image_(static_cast<std::size_t>(side_ * side_)),
        rows_(image_.size()),
        smooth_(image_.size()) {}

  /// `smoothings` >= 1 passes of the filter.
  double operator()(const TileEvents& events, const Eigen::Vector2d& displacement,
                    int smoothings = 1) {
    std::fill(image_.begin(), image_.end(), 0.F);
    const auto last = static_cast<float>(side_ - 2);
    const auto dx = static_cast<float>(displacement.x()), dy = static_cast<float>(displacement.y());
    for (std::size_t i = 0; i < events.time.size(); ++i) {
      const float x = events.x_px[i] - dx * events.time[i] + kMargin_px;
      const float y = events.y_px[i] - dy * events.time[i] + kMargin_px;
      if (!(x >= 1) || !(y >= 1) || !(x < last) || !(y < last)) continue;
      const int u = static_cast<int>(x), v = static_cast<int>(y);
      const float a = x - static_cast<float>(u), b = y - static_cast<float>(v);
      float* at = &image_[static_cast<std::size_t>(v * side_ + u)];
      at[0] += (1 - a) * (1 - b);
      at[1] += a * (1 - b);
      at[side_] += (1 - a) * b;
      at[side_ + 1] += a * b;
    }
    for (int i = 0; i < smoothings; ++i) smooth();
    double sum = 0;
    for (const float value : image_) sum += static_cast<double>(value * value);
    return std::log(std::max(sum, 1e-9));
  }

 private:
  /// A binomial filter of three taps each way. Next to the border there are no events.
  void smooth() {
    const auto side = static_cast<std::size_t>(side_);
    for (std::size_t i = 1; i + 1 < image_.size(); ++i)
      rows_[i] = 0.25F * image_[i - 1] + 0.5F * image_[i] + 0.25F * image_[i + 1];
    for (std::size_t i = side; i + side < image_.size(); ++i)
      smooth_[i] = 0.25F * rows_[i - side] + 0.5F * rows_[i] + 0.25F * rows_[i + side];
    std::swap(image_, smooth_);
  }

  int side_;
  std::vector<float> image_, rows_, smooth_;
};

struct Displacement {
  Eigen::Vector2d px;
  Eigen::Matrix2d information;  ///< of one event
  bool ok = false;
};

/// The best of a grid, coarse and then fine, then the top of the parabola through the values around.
Displacement sharpest(const TileEvents& events, TileContrast& contrast) {
  Displacement best{Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()};
  const auto search = [&](int reach, int step, int smoothings) {
    const Eigen::Vector2d centre = best.px;
    double highest = -1e9;
    for (int v = -reach; v <= reach; v += step)
      for (int u = -reach; u <= reach; u += step) {
        const Eigen::Vector2d at = centre + Eigen::Vector2d(u, v);
        const double value = contrast(events, at, smoothings);
        if (value > highest) highest = value, best.px = at;
      }
  };
  search(kSearch_px, kCoarseStep_px, 3);
  if (best.px.cwiseAbs().maxCoeff() >= kSearch_px) return best;
  search(kCoarseStep_px, 1, 1);
  // value = c + g . d - d' H d / 2 by least squares.
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (int v = -kFineSteps; v <= kFineSteps; ++v)
    for (int u = -kFineSteps; u <= kFineSteps; ++u) {
      const double x = u * kFineStep_px, y = v * kFineStep_px;
      Eigen::Matrix<double, 6, 1> row;
      row << 1, x, y, -x * x / 2, -x * y, -y * y / 2;
      normal += row * row.transpose();
      right += row * contrast(events, best.px + Eigen::Vector2d(x, y));
    }
  const Eigen::Matrix<double, 6, 1> fit = normal.ldlt().solve(right);
  best.information << fit[3], fit[4], fit[4], fit[5];
  // Along an edge the contrast does not change; what is left there is noise.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(best.information);
  Eigen::Vector2d curvature = eigen.eigenvalues();
  if (!(curvature[1] > 0)) return best;
  curvature = curvature.cwiseMax(0.01 * curvature[1]);
  const Eigen::Vector2d step =
      eigen.eigenvectors() *
      (eigen.eigenvectors().transpose() * fit.segment<2>(1)).cwiseQuotient(curvature);
  best.information =
      eigen.eigenvectors() * curvature.asDiagonal() * eigen.eigenvectors().transpose();
  best.px += step.cwiseMax(-1).cwiseMin(1);
  best.ok = true;
  return best;
}

/// From the tile's corner [px].
Eigen::Vector2d centre_of(const TileEvents& events) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < events.time.size(); ++i)
    sum += Eigen::Vector2f(events.x_px[i], events.y_px[i]).cast<double>();
  return sum / static_cast<double>(events.time.size());
}

/// d(x, y)/dt of what the plane shows at a ray [1/s].
Eigen::Vector2d plane_flow(const PlaneMotion& motion, const Eigen::Vector2d& at) {
  const Eigen::Vector3d ray = at.homogeneous();
  const Eigen::Vector3d moved = -motion.rate.cross(ray) - motion.plane().dot(ray) * motion.velocity;
  return moved.head<2>() - moved.z() * at;
}

}  // namespace

std::vector<TileFlow> tile_flows(std::span<const Event> events, BurstFilter& filter,
                                 const PinholeCamera& camera, const PlaneMotion& motion) {
  const WindowRays rays = filter.rays_of(events);
  const double window_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  const int tile_px = std::max(1, camera.width / kColumns);
  const int columns = camera.width / tile_px, rows = camera.height / tile_px;
  std::vector<TileEvents> tiles(static_cast<std::size_t>(columns * rows));
  for (std::size_t i = 0; i < rays.t.size(); ++i) {
    const auto t_s = static_cast<double>(rays.t[i]);
    const Rigid3 pose = motion.reference_from_camera(t_s);
    const Eigen::Vector3d ray =
        pose.rotation() *
        Eigen::Vector3d(static_cast<double>(rays.x[i]), static_cast<double>(rays.y[i]), 1);
    const double reach = (1 - motion.plane().dot(pose.translation())) / motion.plane().dot(ray);
    const Eigen::Vector3d point = pose.translation() + reach * ray;
    if (!(reach > 0) || !(point.z() > 0)) continue;
    const Eigen::Vector2d pixel = camera.project(point) + Eigen::Vector2d(0.5, 0.5);
    if (!(pixel.x() >= 0) || !(pixel.y() >= 0)) continue;
    const int column = static_cast<int>(pixel.x()) / tile_px;
    const int row = static_cast<int>(pixel.y()) / tile_px;
    if (column >= columns || row >= rows) continue;
    TileEvents& tile = tiles[static_cast<std::size_t>(row * columns + column)];
    tile.x_px.push_back(static_cast<float>(pixel.x() - column * tile_px));
    tile.y_px.push_back(static_cast<float>(pixel.y() - row * tile_px));
    tile.time.push_back(static_cast<float>(t_s / window_s));
  }
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  TileContrast contrast(tile_px);
  std::vector<TileFlow> flows;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const TileEvents& tile = tiles[static_cast<std::size_t>(row * columns + column)];
      if (tile.time.size() < kLeastEvents) continue;
      const Displacement found = sharpest(tile, contrast);
      if (!found.ok) continue;
      TileFlow flow;
      const Eigen::Vector2d corner(column * tile_px - 0.5, row * tile_px - 0.5);
      flow.ray = camera.ray(corner + centre_of(tile)).head<2>();
      flow.flow = plane_flow(motion, flow.ray) + found.px.cwiseQuotient(focal) / window_s;
      const Eigen::Matrix2d px_per_flow = (window_s * focal).asDiagonal();
      flow.information =
          static_cast<double>(tile.time.size()) * px_per_flow * found.information * px_per_flow;
      flows.push_back(flow);
    }
  return flows;
}

}  // namespace saccade
