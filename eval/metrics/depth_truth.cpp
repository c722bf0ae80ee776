#include "eval/metrics/depth_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace saccade {
namespace {

constexpr double kMaxDepthRatio = 1.1;  ///< of neighbours on one surface
constexpr double kEdgeStrength = 0.1;   ///< |grad L| of an edge [1/px]
constexpr double kHidden = 0.1;         ///< relative depth behind what is seen, of what is hidden
constexpr double kSameTimeS = 1e-4;

/// A pixel of the source in the target.
struct Vertex {
  Eigen::Vector2d pixel;
  double inverse_depth = 0;  ///< 0: none
};

std::vector<Vertex> project_all(const ImageF& depth, const PinholeCamera& camera,
                                const Rigid3& target_from_source) {
  const PinholeCamera target = camera.undistorted();
  std::vector<Vertex> vertices(depth.size());
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const auto z = static_cast<double>(depth(x, y));
      if (!(z > 0) || !std::isfinite(z)) continue;
      const Eigen::Vector3d ray = camera.ray(camera.undistort({x, y}));
      const Eigen::Vector3d point = target_from_source * (z * ray);
      if (point.z() <= 0) continue;
      Vertex& vertex =
          vertices[static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width()) +
                   static_cast<std::size_t>(x)];
      vertex = {target.project(point), 1 / point.z()};
    }
  return vertices;
}

void put(ImageF& inverse, int x, int y, double value) {
  inverse(x, y) = std::max(inverse(x, y), static_cast<float>(value));
}

/// Fills the pixels whose centres lie in the triangle; borders included.
void draw_triangle(const std::array<Vertex, 3>& v, ImageF& inverse) {
  for (const Vertex& a : v)
    for (const Vertex& b : v)
      if (!(a.inverse_depth > 0) || a.inverse_depth > kMaxDepthRatio * b.inverse_depth) return;
  const Eigen::Vector2d e1 = v[1].pixel - v[0].pixel;
  const Eigen::Vector2d e2 = v[2].pixel - v[0].pixel;
  const double area = e1.x() * e2.y() - e1.y() * e2.x();
  if (std::abs(area) < 1e-12) return;
  const Eigen::Vector2d low = v[0].pixel.cwiseMin(v[1].pixel).cwiseMin(v[2].pixel);
  const Eigen::Vector2d high = v[0].pixel.cwiseMax(v[1].pixel).cwiseMax(v[2].pixel);
  constexpr double kBorder = 1e-6;
  const int left = std::max(0, static_cast<int>(std::ceil(low.x() - kBorder)));
  const int top = std::max(0, static_cast<int>(std::ceil(low.y() - kBorder)));
  const double right = std::min<double>(inverse.width() - 1, high.x() + kBorder);
  const double bottom = std::min<double>(inverse.height() - 1, high.y() + kBorder);
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector2d p = Eigen::Vector2d(x, y) - v[0].pixel;
      const double s = (p.x() * e2.y() - p.y() * e2.x()) / area;
      const double t = (e1.x() * p.y() - e1.y() * p.x()) / area;
      if (s < -kBorder || t < -kBorder || s + t > 1 + kBorder) continue;
      put(inverse, x, y,
          (1 - s - t) * v[0].inverse_depth + s * v[1].inverse_depth + t * v[2].inverse_depth);
    }
}

/// Index of the file nearest in time, not `except`; nullopt where there is none.
std::optional<std::size_t> nearest(const std::vector<StampedFile>& files, double t_s,
                                   std::optional<std::size_t> except = std::nullopt) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (i == except) continue;
    if (!best || std::abs(files[i].t_s - t_s) < std::abs(files[*best].t_s - t_s)) best = i;
  }
  return best;
}

/// The pixels of a frame with depth that are edges, carried over to where they are visible.
void draw_edges(const Dataset& dataset, std::size_t frame, std::size_t map,
                const Rigid3& target_from_source, DepthTruth& truth) {
  const PinholeCamera& camera = dataset.camera();
  const ImageF radiance = dataset.load_frame(frame);
  const ImageF depth = dataset.load_depth(map);
  if (radiance.width() != depth.width() || radiance.height() != depth.height()) return;
  truth.has_edges = true;
  const double eps = dataset.facts().log_eps;
  const auto level = [&](int x, int y) {
    return std::log(eps + static_cast<double>(radiance(x, y)));
  };
  const auto vertices = project_all(depth, camera, target_from_source);
  for (int y = 1; y + 1 < depth.height(); ++y)
    for (int x = 1; x + 1 < depth.width(); ++x) {
      const double dx = (level(x + 1, y) - level(x - 1, y)) / 2;
      const double dy = (level(x, y + 1) - level(x, y - 1)) / 2;
      if (!(std::hypot(dx, dy) >= kEdgeStrength)) continue;
      const Vertex& v =
          vertices[static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width()) +
                   static_cast<std::size_t>(x)];
      if (!(v.inverse_depth > 0) || !is_inside(truth.depth, v.pixel.x(), v.pixel.y())) continue;
      const auto u = static_cast<int>(std::lround(v.pixel.x()));
      const auto w = static_cast<int>(std::lround(v.pixel.y()));
      // Where no depth is known, the product is 0.
      if (static_cast<double>(truth.depth(u, w)) * v.inverse_depth > 1 - kHidden)
        truth.edges(u, w) = 1;
    }
}

}  // namespace

ImageF warp_depth(const ImageF& depth, const PinholeCamera& camera,
                  const Rigid3& target_from_source) {
  const auto vertices = project_all(depth, camera, target_from_source);
  const auto at = [&](int x, int y) {
    return vertices[static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width()) +
                    static_cast<std::size_t>(x)];
  };
  ImageF inverse(depth.width(), depth.height());
  for (int y = 0; y + 1 < depth.height(); ++y)
    for (int x = 0; x + 1 < depth.width(); ++x) {
      draw_triangle({at(x, y), at(x + 1, y), at(x, y + 1)}, inverse);
      draw_triangle({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}, inverse);
    }
  // Thin things and rims, which no triangle covers.
  ImageF rims = inverse;
  for (const Vertex& v : vertices)
    if (v.inverse_depth > 0 && is_inside(inverse, v.pixel.x(), v.pixel.y())) {
      const auto x = static_cast<int>(std::lround(v.pixel.x()));
      const auto y = static_cast<int>(std::lround(v.pixel.y()));
      if (!(inverse(x, y) > 0)) put(rims, x, y, v.inverse_depth);
    }
  for (float& value : rims.pixels()) value = value > 0 ? 1 / value : 0;
  return rims;
}

std::optional<DepthTruth> depth_truth_at(const Dataset& dataset, double t_s) {
  const auto& maps = dataset.depth_maps();
  const Trajectory& poses = dataset.groundtruth();
  const auto first = nearest(maps, t_s);
  if (!first || poses.empty()) return std::nullopt;
  DepthTruth truth;
  // An end of the trajectory may be rounded away by a few microseconds.
  if (t_s < poses.start_s() - kSameTimeS || t_s > poses.end_s() + kSameTimeS) return std::nullopt;
  truth.world_from_camera = poses.at_clamped(t_s);
  const auto target_from = [&](double source_s) {
    return truth.world_from_camera.inverse() * poses.at_clamped(source_s);
  };
  truth.depth =
      warp_depth(dataset.load_depth(*first), dataset.camera(), target_from(maps[*first].t_s));
  if (const auto second = nearest(maps, t_s, first);
      second && std::abs(maps[*first].t_s - t_s) > kSameTimeS) {
    const ImageF filling =
        warp_depth(dataset.load_depth(*second), dataset.camera(), target_from(maps[*second].t_s));
    for (std::size_t i = 0; i < filling.size(); ++i)
      if (!(truth.depth.pixels()[i] > 0)) truth.depth.pixels()[i] = filling.pixels()[i];
  }
  truth.edges = ImageU8(truth.depth.width(), truth.depth.height());
  const auto frame = nearest(dataset.frames(), t_s);
  if (!frame) return truth;
  const double frame_s = dataset.frames()[*frame].t_s;
  const auto map = nearest(maps, frame_s);
  if (std::abs(maps[*map].t_s - frame_s) <= kSameTimeS)
    draw_edges(dataset, *frame, *map, target_from(frame_s), truth);
  return truth;
}

}  // namespace saccade
