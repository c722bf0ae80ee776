#include "estimator/odometry/start/tile_flow.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Dense>

#include "core/process/parallel.h"

namespace saccade {
namespace {

/// Across the sensor: a tile holds edges of several directions, yet hardly a change of depth.
constexpr int kColumns = 8;
constexpr int kLeastSide_px = 8;  ///< of a tile of a small sensor
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
  // Bounded across and along the edge: along it the step is noise, however long.
  const Eigen::Vector2d step =
      (eigen.eigenvectors().transpose() * fit.segment<2>(1)).cwiseQuotient(curvature);
  best.information =
      eigen.eigenvectors() * curvature.asDiagonal() * eigen.eigenvectors().transpose();
  best.px += eigen.eigenvectors() * step.cwiseMax(-1).cwiseMin(1);
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

/// Tiles of equal size that cover the sensor, about square.
struct TileGrid {
  int columns, rows;
  double width_px, height_px;

  explicit TileGrid(const PinholeCamera& camera)
      : columns(std::clamp(camera.width / kLeastSide_px, 1, kColumns)),
        rows(std::clamp(static_cast<int>(std::lround(static_cast<double>(camera.height) * columns /
                                                     camera.width)),
                        1, std::max(1, camera.height / kLeastSide_px))),
        width_px(static_cast<double>(camera.width) / columns),
        height_px(static_cast<double>(camera.height) / rows) {}

  [[nodiscard]] int side_px() const {
    return static_cast<int>(std::ceil(std::max(width_px, height_px)));
  }
};

/// The events by tile, where the motion warps them to in the middle of the window.
std::vector<TileEvents> sorted_into_tiles(const WindowRays& rays, double window_s,
                                          const PinholeCamera& camera, const PlaneMotion& motion,
                                          const TileGrid& grid) {
  std::vector<TileEvents> tiles(static_cast<std::size_t>(grid.columns * grid.rows));
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
    if (!(pixel.x() >= 0) || !(pixel.y() >= 0) || !(pixel.x() < camera.width) ||
        !(pixel.y() < camera.height))
      continue;
    const int column = std::min(grid.columns - 1, static_cast<int>(pixel.x() / grid.width_px));
    const int row = std::min(grid.rows - 1, static_cast<int>(pixel.y() / grid.height_px));
    TileEvents& tile = tiles[static_cast<std::size_t>(row * grid.columns + column)];
    tile.x_px.push_back(static_cast<float>(pixel.x() - column * grid.width_px));
    tile.y_px.push_back(static_cast<float>(pixel.y() - row * grid.height_px));
    tile.time.push_back(static_cast<float>(t_s / window_s));
  }
  return tiles;
}

}  // namespace

std::vector<TileFlow> tile_flows(std::span<const Event> events, BurstFilter& filter,
                                 const PinholeCamera& camera, const PlaneMotion& motion) {
  const double window_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  if (!(window_s > 0)) return {};
  const TileGrid grid(camera);
  const std::vector<TileEvents> tiles =
      sorted_into_tiles(filter.rays_of(events), window_s, camera, motion, grid);
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  std::vector<std::optional<TileFlow>> found(tiles.size());
  parallel_for(tiles.size(), [&](std::size_t k) {
    const TileEvents& tile = tiles[k];
    if (tile.time.size() < kLeastEvents) return;
    TileContrast contrast(grid.side_px());
    const Displacement displacement = sharpest(tile, contrast);
    if (!displacement.ok) return;
    const auto columns = static_cast<std::size_t>(grid.columns);
    const Eigen::Vector2d corner(static_cast<double>(k % columns) * grid.width_px - 0.5,
                                 static_cast<double>(k / columns) * grid.height_px - 0.5);
    TileFlow flow;
    flow.ray = camera.ray(corner + centre_of(tile)).head<2>();
    flow.flow = plane_flow(motion, flow.ray) + displacement.px.cwiseQuotient(focal) / window_s;
    const Eigen::Matrix2d px_per_flow = (window_s * focal).asDiagonal();
    flow.information = static_cast<double>(tile.time.size()) * px_per_flow *
                       displacement.information * px_per_flow;
    if (flow.flow.allFinite() && flow.information.allFinite()) found[k] = flow;
  });
  std::vector<TileFlow> flows;
  for (const std::optional<TileFlow>& flow : found)
    if (flow) flows.push_back(*flow);
  return flows;
}

}  // namespace saccade
