#include "simulator/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "core/check.h"
#include "core/median.h"
#include "core/process/parallel.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/build_scene.h"
#include "simulator/sensor/image_renderer.h"

namespace saccade {
namespace {

/// Poses that draw the path as a smooth line at any zoom of a sheet.
constexpr int kPathPoses = 200;
/// The least half side of a plan: around a camera that rotates in place before the background.
constexpr double kLeastPlan_m = 0.5;

std::vector<StampedPose> even_poses(const Spline& motion, int count) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < count; ++i) {
    const double t_s = motion.start_s() + (motion.end_s() - motion.start_s()) * i / (count - 1);
    poses.push_back({t_s, motion.pose(t_s)});
  }
  return poses;
}

ImageF log_image(const ImageF& radiance, double log_eps) {
  ImageF log(radiance.width(), radiance.height());
  std::ranges::transform(radiance.pixels(), log.data(), [&](float value) {
    return static_cast<float>(std::log(log_eps + static_cast<double>(value)));
  });
  return log;
}

double event_rate(const ImageF& radiance, const FlowField& flow, const EventOptions& options) {
  const ImageF log = log_image(radiance, options.log_eps);
  double rate = 0;
  for (int y = 1; y + 1 < log.height(); ++y)
    for (int x = 1; x + 1 < log.width(); ++x) {
      const float change = -0.5F * ((log(x + 1, y) - log(x - 1, y)) * flow.u(x, y) +
                                    (log(x, y + 1) - log(x, y - 1)) * flow.v(x, y));
      const double threshold = change > 0 ? options.contrast.on : options.contrast.off;
      if (std::isfinite(change)) rate += std::abs(static_cast<double>(change)) / threshold;
    }
  return rate;
}

double median_flow(const FlowField& flow) {
  std::vector<double> lengths;
  for (int y = 0; y < flow.u.height(); ++y)
    for (int x = 0; x < flow.u.width(); ++x) {
      const auto length = static_cast<double>(std::hypot(flow.u(x, y), flow.v(x, y)));
      if (std::isfinite(length)) lengths.push_back(length);
    }
  return lengths.empty() ? 0 : median(lengths);
}

PreviewView look(const ImageRenderer& renderer, const Spline& motion, const StampedPose& pose,
                 const EventOptions& options) {
  PreviewView view;
  view.pose = pose;
  view.radiance = renderer.radiance(std::span(&pose, 1));
  std::vector<double> depths;
  const ImageF depth = renderer.depth(pose);
  for (const float z : depth.pixels())
    if (z > 0) depths.push_back(static_cast<double>(z));
  if (!depths.empty()) {
    view.nearest_m = std::ranges::min(depths);
    view.median_m = median(depths);
  }
  const FlowField flow = renderer.flow(motion.state(pose.t_s), pose.t_s);
  view.flow_px_per_s = median_flow(flow);
  view.events_per_s = event_rate(view.radiance, flow, options);
  return view;
}

PlanView draw_plan(const Scene& scene, const ScenePreview& seen, int size_px) {
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : seen.path) box.extend(pose.world_from_camera.translation());
  double beyond_m = kLeastPlan_m;
  for (const PreviewView& view : seen.views) beyond_m = std::max(beyond_m, view.median_m);
  const double half_m = 0.5 * std::max(box.sizes().x(), box.sizes().y()) + beyond_m;
  PlanView plan{ImageF(size_px, size_px), box.center().head<2>(), size_px / (2 * half_m)};
  parallel_for(static_cast<std::size_t>(size_px), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int first = 0; first < size_px; first += static_cast<int>(kRayPacket)) {
      std::array<Ray, kRayPacket> rays;
      std::array<TriangleId, kRayPacket> triangles{};
      const auto count =
          std::min<std::size_t>(kRayPacket, static_cast<std::size_t>(size_px - first));
      for (std::size_t k = 0; k < count; ++k) {
        const double column = first + static_cast<double>(k) + 0.5 - 0.5 * size_px;
        const double up = 0.5 * size_px - y - 0.5;
        const Eigen::Vector2d point = plan.centre_m + Eigen::Vector2d(column, up) / plan.px_per_m;
        rays[k] = {{point.x(), point.y(), box.max().z()}, -Eigen::Vector3d::UnitZ(), 0};
      }
      scene.visible(std::span(rays).first(count), std::span(triangles).first(count));
      for (std::size_t k = 0; k < count; ++k)
        plan.radiance(first + static_cast<int>(k), y) =
            triangles[k] == kNothing
                ? 0
                : static_cast<float>(scene.shade(rays[k], triangles[k]).radiance);
    }
  });
  return plan;
}

}  // namespace

ScenePreview preview(const SimulationConfig& config, int views, int plan_px) {
  SACCADE_CHECK(views >= 2 && plan_px >= 1);
  const Spline motion =
      cut_motion(build_motion(config.trajectory), config.start_s, config.duration_s);
  const Scene scene = build_scene(config.scene);
  const ImageRenderer renderer(scene, config.camera, config.events.samples_per_pixel,
                               config.events.texture_filter);
  ScenePreview seen;
  seen.path = even_poses(motion, kPathPoses);
  for (const StampedPose& pose : even_poses(motion, views))
    seen.views.push_back(look(renderer, motion, pose, config.events));
  seen.plan = draw_plan(scene, seen, plan_px);
  return seen;
}

}  // namespace saccade
