#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/tracking/edges/edge_tracker.h"
#include "estimator/tracking/reference_view.h"
#include "estimator/tracking/track_config.h"
#include "tests/support/planar_world.h"
#include "tests/support/source_path.h"

namespace saccade::testing {

constexpr double kRecordedContrast = 0.15;

/// What corner_motion() sees of a world of planes: the first view and the events since then.
struct CornerRecording {
  PlanarWorld world;
  ReferenceView view;
  Events events;

  CornerRecording(PlanarWorld planes, double end_s, double step_s,
                  double contrast = kRecordedContrast)
      : world(std::move(planes)),
        view{world.log_intensity(corner_motion(0)), world.depth(corner_motion(0)),
             corner_motion(0)},
        events(world.simulate(corner_motion, 0, end_s, step_s, contrast)) {}

  /// RMS distance between a pose and the true one of what the first view shows [px].
  [[nodiscard]] double error_px(const TrackedPose& pose) const {
    const PinholeCamera& camera = world.camera();
    const Rigid3 truth = corner_motion(seconds_from_ns(pose.t_ns)).inverse() * corner_motion(0);
    const Rigid3 estimate = pose.world_from_camera.inverse() * corner_motion(0);
    double squared = 0;
    double count = 0;
    for (int y = 0; y < camera.height; y += 5)
      for (int x = 0; x < camera.width; x += 5) {
        const double depth = static_cast<double>(view.depth(x, y));
        if (!(depth > 0)) continue;
        const Eigen::Vector3d point = depth * camera.ray({x, y});
        const Eigen::Vector2d u = camera.project(truth * point);
        if (!camera.contains(u)) continue;
        squared += (u - camera.project(estimate * point)).squaredNorm();
        ++count;
      }
    return std::sqrt(squared / count);
  }

  /// Of error_px().
  struct Errors {
    double mean = 0;
    double largest = 0;
  };
  [[nodiscard]] Errors errors_of(const std::vector<TrackedPose>& poses) const {
    Errors errors;
    for (const TrackedPose& pose : poses) {
      const double error = error_px(pose);
      errors.mean += error / static_cast<double>(poses.size());
      errors.largest = std::max(errors.largest, error);
    }
    return errors;
  }
};

/// Two walls and a smaller plane before them whose texels are larger than a pixel of 160 x 120, so
/// that the picture of a view shows all there is.
inline PlanarWorld resolved_world() {
  return {corner_world(160, 120).camera(),
          {{{-2.6, -1.6, 1.8}, {2.8, 0, 1.6}, {0, 3.2, 0}, patch_texture(90, 90, 1)},
           {{0.2, -1.6, 3.4}, {2.4, 0, -1.8}, {0, 3.2, 0}, patch_texture(90, 90, 2)},
           {{-0.5, -0.2, 1.5}, {0.7, 0, 0.1}, {0, 0.6, 0}, patch_texture(32, 28, 3)}}};
}

/// 0.3 s of it, some 60 px of image motion; made once. Steps of 0.2 ms, a twentieth of a pixel, so
/// that linear interpolation between them is as good as exact.
inline const CornerRecording& resolved_recording() {
  static const CornerRecording recording(resolved_world(), 0.3, 2e-4);
  return recording;
}

/// Of the poses that a tracker found in it.
inline CornerRecording::Errors resolved_errors(const std::vector<TrackedPose>& poses) {
  return resolved_recording().errors_of(poses);
}

/// A file of configs/tracking, without its ending.
inline TrackConfig tracking_config(const std::string& name) {
  const std::string file = testing::source_path("configs/tracking/") + name + ".yaml";
  return config::read<TrackConfig>(config::load(file));
}

/// The edges that a method falls back to, as track_config.cpp sets them.
inline EdgeTrackerOptions fallback_options(const TrackConfig& config) {
  EdgeTrackerOptions options;
  options.templates.redraw_px = 0;
  options.motion = config.motion;
  return options;
}

/// The same bits.
inline void expect_equal(const std::vector<TrackedPose>& a, const std::vector<TrackedPose>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].t_ns, b[i].t_ns);
    EXPECT_EQ(a[i].status, b[i].status);
    EXPECT_EQ(a[i].world_from_camera.translation(), b[i].world_from_camera.translation());
    EXPECT_EQ(a[i].world_from_camera.rotation().coeffs(),
              b[i].world_from_camera.rotation().coeffs());
    EXPECT_EQ(a[i].inlier_ratio, b[i].inlier_ratio);
  }
}

/// What a tracker does that sees nothing of its map.
inline void expect_lost_but_finite(const std::vector<TrackedPose>& poses) {
  EXPECT_FALSE(poses.empty());
  for (const TrackedPose& pose : poses) {
    EXPECT_EQ(pose.status, TrackStatus::kLost);
    EXPECT_TRUE(pose.world_from_camera.translation().allFinite());
    EXPECT_TRUE(pose.world_from_camera.rotation().coeffs().allFinite());
    EXPECT_TRUE(std::isfinite(pose.inlier_ratio));
  }
}

}  // namespace saccade::testing
