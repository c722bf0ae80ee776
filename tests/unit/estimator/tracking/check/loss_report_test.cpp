#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/time_search.h"
#include "estimator/tracking/check/pose_monitor.h"
#include "estimator/tracking/map_extraction.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/tracker_feed.h"
#include "tests/unit/estimator/tracking/corner_recording.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::Motion;
using testing::PlanarWorld;
using testing::resolved_world;

constexpr double kContrast = testing::kRecordedContrast;
constexpr double kStep_s = 5e-4;
constexpr double kFrameInterval_s = 0.02;
constexpr double kBreak_s = 0.1;  ///< until then all is well
constexpr double kLast_s = 0.3;

/// What a camera delivers while it loses its world.
struct LosingRecording {
  Motion motion;
  Events events;
  std::vector<GreyFrame> frames;
  double end_s = kLast_s;
};

std::vector<GreyFrame> frames_of(const PlanarWorld& world, const Motion& motion) {
  std::vector<GreyFrame> frames;
  for (int k = 0; k * kFrameInterval_s <= kLast_s; ++k)
    frames.push_back(
        {ns_from_seconds(k * kFrameInterval_s), world.log_intensity(motion(k * kFrameInterval_s))});
  return frames;
}

/// Two recordings cut together: the camera looks 14 degrees further to the side at once.
LosingRecording jump() {
  const PlanarWorld world = resolved_world();
  const Motion motion = [](double t_s) {
    const Rigid3 pose = corner_glide(t_s);
    return t_s < kBreak_s ? pose : pose * Rigid3(so3_exp({0, 0.25, 0}), {0, 0, 0});
  };
  LosingRecording recording{motion, world.simulate(motion, 0, kBreak_s - 1e-6, kStep_s, kContrast),
                            frames_of(world, motion)};
  const Events after = world.simulate(motion, kBreak_s, kLast_s, kStep_s, kContrast);
  recording.events.insert(recording.events.end(), after.begin(), after.end());
  return recording;
}

/// The lens is covered for 0.15 s.
LosingRecording cover() {
  const PlanarWorld world = resolved_world();
  const auto is_covered = [](TimeNs t_ns) {
    const double t_s = seconds_from_ns(t_ns);
    return t_s >= kBreak_s && t_s < kBreak_s + 0.15;
  };
  LosingRecording recording{corner_glide,
                            world.simulate(corner_glide, 0, kLast_s, kStep_s, kContrast),
                            frames_of(world, corner_glide)};
  std::erase_if(recording.events, [&](const Event& event) { return is_covered(event.t_ns); });
  for (GreyFrame& frame : recording.frames)
    if (is_covered(frame.t_ns)) std::ranges::fill(frame.log_intensity.pixels(), -6.0F);
  return recording;
}

/// The camera turns faster and faster, away from its map and then to where nothing is.
LosingRecording blank_wall() {
  const PlanarWorld world = resolved_world();
  const Motion motion = [](double t_s) {
    return Rigid3(so3_exp({0, 22 * t_s * t_s, 0}), {0.3 * t_s, 0, 0});
  };
  return {motion, world.simulate(motion, 0, kLast_s, kStep_s, kContrast), frames_of(world, motion)};
}

const LosingRecording& recording_of(const std::string& name) {
  static const LosingRecording jumped = jump(), covered = cover(), blank = blank_wall();
  return name == "jump" ? jumped : name == "cover" ? covered : blank;
}

TrackWorld map_of(const TrackConfig& config, const TrackMethod& method, const PlanarWorld& world,
                  const Rigid3& pose) {
  const ReferenceView view{world.log_intensity(pose), world.depth(pose), pose};
  const PinholeCamera& camera = world.camera();
  return {camera, extract_map(view.log_intensity, view.depth, camera, config.map),
          IntensityMap(camera, std::span(&view, 1),
                       method.smooths_map ? config.intensity.map_blur_px : 0),
          EventContrast{kContrast, kContrast}, Gyroscope()};
}

/// As `saccade run track` does it.
std::vector<TrackedPose> judged_poses(const TrackMethod& method, const PlanarWorld& mapped,
                                      const LosingRecording& what) {
  const auto config = config::read<TrackConfig>(
      config::parse("{method: " + std::string(method.name) + "}", "t.yaml"));
  const TrackWorld world = map_of(config, method, mapped, what.motion(0));
  const std::unique_ptr<Tracker> tracker = method.make(config, world);
  tracker->reset(method.takes_frames ? 0 : what.events.front().t_ns, what.motion(0));
  const Recording recording =
      method.takes_frames ? Recording{.frames = what.frames} : Recording{.events = what.events};
  std::vector<TrackedPose> poses = tracker->track(recording);
  judge_poses(world.camera, recording, world.edge_points, world.intensity_map.world_from_map(),
              poses);
  report_gaps(ns_from_seconds(what.end_s), poses);
  return poses;
}

/// Whether a pose is beyond the limits.
bool is_truly_lost(const Rigid3& estimate, const Rigid3& truth) {
  return (estimate.translation() - truth.translation()).norm() >
             kLossDepthRatio * testing::kCornerDepth_m ||
         angle_between(estimate.rotation(), truth.rotation()) > kLossAngle_rad;
}

/// Milliseconds that are truly lost, and the longest stretch of them without a report.
struct LossTimes {
  int lost_ms = 0;
  int longest_unreported_ms = 0;
};

LossTimes loss_times(const std::vector<TrackedPose>& poses, const LosingRecording& what) {
  LossTimes times;
  int unreported_ms = 0;
  for (int ms = 0; ms * 1e-3 < what.end_s; ++ms) {
    const std::size_t until = count_until(poses, ns_from_seconds(ms * 1e-3), &TrackedPose::t_ns);
    const TrackedPose& held = poses[until == 0 ? 0 : until - 1];
    const bool is_lost = is_truly_lost(held.world_from_camera, what.motion(ms * 1e-3));
    times.lost_ms += is_lost ? 1 : 0;
    unreported_ms = is_lost && held.status != TrackStatus::kLost ? unreported_ms + 1 : 0;
    times.longest_unreported_ms = std::max(times.longest_unreported_ms, unreported_ms);
  }
  return times;
}

class LossReport : public ::testing::TestWithParam<std::tuple<TrackMethod, const char*>> {};

TEST_P(LossReport, ComesWithin50Ms) {
  const auto& [method, name] = GetParam();
  const LosingRecording& what = recording_of(name);
  const std::vector<TrackedPose> poses = judged_poses(method, resolved_world(), what);
  ASSERT_FALSE(poses.empty());
  const LossTimes times = loss_times(poses, what);
  EXPECT_GT(times.lost_ms, 0) << "nothing was lost";
  EXPECT_LE(times.longest_unreported_ms, 50) << "of " << times.lost_ms << " ms";
  for (const TrackedPose& pose : poses)
    if (seconds_from_ns(pose.last_ns) < kBreak_s) {
      EXPECT_NE(pose.status, TrackStatus::kLost) << seconds_from_ns(pose.t_ns);
    }
}

TEST_P(LossReport, IsTheSameForEventsInPieces) {
  const auto& [method, name] = GetParam();
  if (method.takes_frames) GTEST_SKIP() << "takes frames, which come at once";
  const LosingRecording& what = recording_of(name);
  const std::vector<TrackedPose> whole = judged_poses(method, resolved_world(), what);
  const auto config = config::read<TrackConfig>(
      config::parse("{method: " + std::string(method.name) + "}", "t.yaml"));
  const TrackWorld world = map_of(config, method, resolved_world(), what.motion(0));
  for (const std::size_t size : {137U, 4001U}) {
    const std::unique_ptr<Tracker> tracker = method.make(config, world);
    TrackerFeed feed(*tracker, world, what.motion(0));
    std::vector<TrackedPose> poses;
    const auto append = [&](const std::vector<TrackedPose>& found) {
      poses.insert(poses.end(), found.begin(), found.end());
    };
    for (std::span<const Event> rest = what.events; !rest.empty();) {
      // As a stream gives them: those of one time together.
      std::size_t count = std::min(size, rest.size());
      while (count < rest.size() && rest[count].t_ns == rest[count - 1].t_ns) ++count;
      std::ranges::copy(rest.first(count), feed.room(count).begin());
      append(feed.feed());
      rest = rest.subspan(count);
    }
    append(feed.finish());
    report_gaps(ns_from_seconds(what.end_s), poses);
    ASSERT_EQ(poses.size(), whole.size()) << "pieces of " << size;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_EQ(poses[i].last_ns, whole[i].last_ns) << i;
      ASSERT_EQ(poses[i].status, whole[i].status) << i;
      ASSERT_EQ(poses[i].probability, whole[i].probability) << i;
      ASSERT_EQ(poses[i].world_from_camera.translation(), whole[i].world_from_camera.translation());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, LossReport,
                         ::testing::Combine(::testing::ValuesIn(track_methods().begin(),
                                                                track_methods().end()),
                                            ::testing::Values("jump", "cover", "blank")),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param).name) + "_" +
                                  std::get<1>(test.param);
                         });

class PoseProbability : public ::testing::TestWithParam<TrackMethod> {
 protected:
  /// A tenth of a second of steady motion, tracked by the map of a world.
  [[nodiscard]] static std::vector<TrackedPose> poses_by(const PlanarWorld& mapped) {
    LosingRecording part = recording_of("cover");
    std::erase_if(part.events,
                  [](const Event& event) { return seconds_from_ns(event.t_ns) >= kBreak_s; });
    std::erase_if(part.frames,
                  [](const GreyFrame& frame) { return seconds_from_ns(frame.t_ns) >= kBreak_s; });
    part.end_s = kBreak_s;
    std::vector<TrackedPose> poses = judged_poses(GetParam(), mapped, part);
    EXPECT_FALSE(poses.empty());
    for (const TrackedPose& pose : poses) {
      EXPECT_GE(pose.probability, 0);
      EXPECT_LE(pose.probability, 1);
    }
    return poses;
  }
};

TEST_P(PoseProbability, IsHighInAKnownWorld) {
  for (const TrackedPose& pose : poses_by(resolved_world())) {
    EXPECT_GT(pose.probability, 0.9) << seconds_from_ns(pose.t_ns);
    EXPECT_EQ(pose.status, TrackStatus::kOk);
  }
}

TEST_P(PoseProbability, IsLowByTheMapOfAnotherWorld) {
  // Not even the borders of the planes are alike.
  const PlanarWorld other(
      resolved_world().camera(),
      {{{-4, -3, 2.3}, {8, 0, 0.6}, {0, 6, 0}, testing::patch_texture(230, 180, 11)}});
  for (const TrackedPose& pose : poses_by(other)) {
    if (seconds_from_ns(pose.t_ns) < 0.05) continue;
    EXPECT_LT(pose.probability, 0.2) << seconds_from_ns(pose.t_ns);
    EXPECT_EQ(pose.status, TrackStatus::kLost);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PoseProbability,
                         ::testing::ValuesIn(track_methods().begin(), track_methods().end()),
                         [](const auto& method) { return std::string(method.param.name); });

}  // namespace
}  // namespace saccade
