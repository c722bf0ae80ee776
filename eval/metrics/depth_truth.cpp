#include "eval/metrics/depth_truth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/depth_mesh.h"

namespace saccade {
namespace {

constexpr double kEdgeStrength = 0.1;  ///< |grad L| of an edge [1/px]
constexpr float kHidden =
    0.1F;  ///< relative depth behind the visible surface from which a point is hidden
constexpr double kSameTimeS = 1e-4;

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
  const auto vertices = DepthMesh(depth, camera).project(target_from_source, camera.undistorted());
  for (int y = 1; y + 1 < depth.height(); ++y)
    for (int x = 1; x + 1 < depth.width(); ++x) {
      const double dx = (level(x + 1, y) - level(x - 1, y)) / 2;
      const double dy = (level(x, y + 1) - level(x, y - 1)) / 2;
      if (!(std::hypot(dx, dy) >= kEdgeStrength)) continue;
      const DepthMesh::Vertex& v =
          vertices[static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width()) +
                   static_cast<std::size_t>(x)];
      if (!(v.inverse_depth > 0) || !is_inside(truth.depth, v.x, v.y)) continue;
      const auto u = static_cast<int>(std::lround(v.x));
      const auto w = static_cast<int>(std::lround(v.y));
      // Where no depth is known, the product is 0.
      if (truth.depth(u, w) * v.inverse_depth > 1 - kHidden) truth.edges(u, w) = 1;
    }
}

}  // namespace

ImageF warp_depth(const ImageF& depth, const PinholeCamera& camera,
                  const Rigid3& target_from_source) {
  const DepthMesh mesh(depth, camera);
  const auto vertices = mesh.project(target_from_source, camera.undistorted());
  ImageF inverse(depth.width(), depth.height());
  mesh.draw(vertices, inverse);
  // Thin things and rims, which no triangle covers.
  ImageF rims = inverse;
  for (const DepthMesh::Vertex& v : vertices)
    if (v.inverse_depth > 0 && is_inside(inverse, v.x, v.y)) {
      const auto x = static_cast<int>(std::lround(v.x));
      const auto y = static_cast<int>(std::lround(v.y));
      if (!(inverse(x, y) > 0)) rims(x, y) = std::max(rims(x, y), v.inverse_depth);
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
