#include "eval/information/true_edges.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// What a second of machine time allows; each then stands for the pixels that are left out.
constexpr std::size_t kMostEdges = 6000;
constexpr std::size_t kMostFrames = 60;
constexpr double kSameTimeS = 1e-4;
/// Depth behind the visible surface, relative, from which a point is hidden: beyond what a pixel
/// spans on a slanted surface.
constexpr double kHidden = 0.05;

struct FrameFiles {
  std::size_t frame = 0, depth = 0;
};

/// Frames whose depth and pose are known at the same time.
std::vector<FrameFiles> frames_with_depth(const Dataset& dataset) {
  std::vector<FrameFiles> found;
  std::size_t map = 0;
  const auto& maps = dataset.depth_maps();
  for (std::size_t i = 0; i < dataset.frames().size() && !dataset.groundtruth().empty(); ++i) {
    const double t_s = dataset.frames()[i].t_s;
    while (map < maps.size() && maps[map].t_s < t_s - kSameTimeS) ++map;
    const bool has_depth = map < maps.size() && maps[map].t_s <= t_s + kSameTimeS;
    const bool has_pose = t_s >= dataset.groundtruth().start_s() - kSameTimeS &&
                          t_s <= dataset.groundtruth().end_s() + kSameTimeS;
    if (has_depth && has_pose) found.push_back({i, map});
  }
  if (found.size() <= kMostFrames) return found;
  std::vector<FrameFiles> spread;
  for (std::size_t i = 0; i < kMostFrames; ++i)
    spread.push_back(found[i * (found.size() - 1) / (kMostFrames - 1)]);
  return spread;
}

ImageF log_intensity(const ImageF& radiance, double eps) {
  ImageF levels(radiance.width(), radiance.height());
  for (std::size_t i = 0; i < levels.size(); ++i)
    levels.pixels()[i] =
        static_cast<float>(std::log(eps + static_cast<double>(radiance.pixels()[i])));
  return levels;
}

/// The edge at a pixel; nullopt where it is too faint or its depth is not known. A gradient on the
/// sensor is taken for one of the undistorted view: a lens turns and stretches it by some percent.
std::optional<TrueEdge> edge_at(const ImageF& levels, const TrueFrame& frame,
                                const PinholeCamera& camera, int x, int y, double least_strength) {
  const double z = static_cast<double>(frame.depth(x, y));
  const Eigen::Vector2d gradient(static_cast<double>(levels(x + 1, y) - levels(x - 1, y)) / 2,
                                 static_cast<double>(levels(x, y + 1) - levels(x, y - 1)) / 2);
  TrueEdge edge;
  edge.strength = gradient.norm();
  if (!(z > 0) || !(edge.strength >= least_strength)) return std::nullopt;
  const Eigen::Vector2d across = gradient / edge.strength;
  const Eigen::Vector2d pixel = camera.undistort({x, y});
  const Eigen::Vector3d ray = camera.ray(pixel);
  const Eigen::Vector3d next = camera.ray(pixel + Eigen::Vector2d(-across.y(), across.x()));
  edge.point = frame.world_from_camera * Eigen::Vector3d(ray * z);
  edge.along = frame.world_from_camera * Eigen::Vector3d(next * z);
  edge.per_log_z = frame.world_from_camera.rotation() * Eigen::Vector3d(ray * z);
  edge.per_px = frame.world_from_camera.rotation() *
                Eigen::Vector3d(across.x() / camera.fx * z, across.y() / camera.fy * z, 0);
  return edge;
}

std::vector<TrueEdge> edges_of(const ImageF& levels, const TrueFrame& frame,
                               const PinholeCamera& camera, double least_strength) {
  std::vector<TrueEdge> edges;
  for (int y = 1; y + 1 < levels.height(); ++y)
    for (int x = 1; x + 1 < levels.width(); ++x)
      if (const auto edge = edge_at(levels, frame, camera, x, y, least_strength))
        edges.push_back(*edge);
  return edges;
}

}  // namespace

std::optional<Eigen::Vector2d> TrueEdges::pixel_of(const PinholeCamera& camera,
                                                   const Eigen::Vector3d& in_camera) {
  if (!(in_camera.z() > 0)) return std::nullopt;
  const Eigen::Vector2d pixel = camera.project(in_camera);
  const Eigen::Vector2d on_sensor = camera.distort(pixel);
  if (!camera.contains(on_sensor)) return std::nullopt;
  const bool folds_over =
      camera.is_distorted() && (camera.undistort(on_sensor) - pixel).squaredNorm() > 1;
  return folds_over ? std::nullopt : std::optional(pixel);
}

TrueEdges::Sight TrueEdges::sight(const PinholeCamera& camera, std::size_t index,
                                  const Eigen::Vector3d& point) const {
  const TrueFrame& frame = frames[index];
  const Eigen::Vector3d in_camera = frame.world_from_camera.inverse() * point;
  const auto undistorted = pixel_of(camera, in_camera);
  if (!undistorted) return Sight::kOutside;
  const Eigen::Vector2d pixel = camera.distort(*undistorted);
  const double z = static_cast<double>(frame.depth(static_cast<int>(std::lround(pixel.x())),
                                                   static_cast<int>(std::lround(pixel.y()))));
  return z > 0 && in_camera.z() > z * (1 + kHidden) ? Sight::kHidden : Sight::kSeen;
}

std::size_t TrueEdges::nearest_frame(double t_s) const {
  SACCADE_CHECK(!frames.empty());
  const auto after =
      std::lower_bound(frames.begin(), frames.end(), t_s,
                       [](const TrueFrame& frame, double t) { return frame.t_s < t; });
  if (after == frames.begin()) return 0;
  const auto last = static_cast<std::size_t>(std::distance(frames.begin(), after)) - 1;
  if (after == frames.end()) return last;
  return after->t_s - t_s < t_s - frames[last].t_s ? last + 1 : last;
}

TrueEdges find_true_edges(const Dataset& dataset, double least_strength) {
  TrueEdges found;
  const std::vector<FrameFiles> frames = frames_with_depth(dataset);
  for (const FrameFiles& files : frames) {
    const double t_s = dataset.frames()[files.frame].t_s;
    TrueFrame frame{t_s, dataset.load_depth(files.depth), dataset.groundtruth().at_clamped(t_s)};
    const ImageF levels = log_intensity(dataset.load_frame(files.frame), dataset.facts().log_eps);
    if (levels.width() != frame.depth.width() || levels.height() != frame.depth.height()) continue;
    std::vector<TrueEdge> edges = edges_of(levels, frame, dataset.camera(), least_strength);
    const std::size_t step = edges.size() / (kMostEdges / frames.size()) + 1;
    for (std::size_t i = 0; i < edges.size(); i += step) {
      edges[i].pixels = static_cast<double>(step);
      edges[i].frame = found.frames.size();
      found.edges.push_back(edges[i]);
    }
    found.frames.push_back(std::move(frame));
  }
  return found;
}

}  // namespace saccade
