#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/process/parallel.h"
#include "estimator/tracking/map_extraction.h"
#include "estimator/tracking/track_config.h"
#include "tests/unit/estimator/tracking/corner_recording.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::expect_equal;
using testing::resolved_errors;
using testing::resolved_recording;

constexpr double kFramePeriod_s = 0.04;
constexpr double kEnd_s = 0.2;  ///< before the camera turns back

std::span<const Event> events() {
  const Events& all = resolved_recording().events;
  std::size_t count = 0;
  while (count < all.size() && seconds_from_ns(all[count].t_ns) < kEnd_s) ++count;
  return std::span(all).first(count);
}

const std::vector<GreyFrame>& frames() {
  static const std::vector<GreyFrame> frames = [] {
    std::vector<GreyFrame> all;
    for (int k = 0; k * kFramePeriod_s < kEnd_s; ++k)
      all.push_back({ns_from_seconds(k * kFramePeriod_s),
                     resolved_recording().world.log_intensity(corner_motion(k * kFramePeriod_s))});
    return all;
  }();
  return frames;
}

/// What every row of the table promises.
class EveryTrackMethod : public ::testing::TestWithParam<TrackMethod> {
 protected:
  EveryTrackMethod() : world_(world_of(config_, GetParam())) {}
  ~EveryTrackMethod() override { set_thread_count(0); }

  [[nodiscard]] std::unique_ptr<Tracker> make() const {
    std::unique_ptr<Tracker> tracker = GetParam().make(config_, world_);
    tracker->reset(0, corner_motion(0));
    return tracker;
  }
  [[nodiscard]] static Recording recording() {
    return GetParam().takes_frames ? Recording{.frames = frames()} : Recording{.events = events()};
  }

 private:
  static TrackWorld world_of(const TrackConfig& config, const TrackMethod& method) {
    const ReferenceView& view = resolved_recording().view;
    const PinholeCamera& camera = resolved_recording().world.camera();
    return {camera, extract_map(view.log_intensity, view.depth, camera, config.map),
            IntensityMap(camera, std::span(&view, 1),
                         method.smooths_map ? config.intensity.map_blur_px : 0),
            EventContrast{testing::kRecordedContrast, testing::kRecordedContrast}, Gyroscope()};
  }

  const TrackConfig config_ = config::read<TrackConfig>(
      config::parse("{method: " + std::string(GetParam().name) + "}", "t.yaml"));
  const TrackWorld world_;
};

TEST_P(EveryTrackMethod, FollowsAKnownMotion) {
  const std::vector<TrackedPose> poses = make()->track(recording());
  ASSERT_GE(poses.size(), 4U);
  EXPECT_LT(resolved_errors(poses).mean, 1.5);
}

TEST_P(EveryTrackMethod, RepeatsItsBitsForAnyNumberOfThreads) {
  set_thread_count(1);
  const std::unique_ptr<Tracker> tracker = make();
  const std::vector<TrackedPose> first = tracker->track(recording());
  tracker->reset(0, corner_motion(0));
  expect_equal(first, tracker->track(recording()));
  set_thread_count(3);
  expect_equal(first, make()->track(recording()));
}

TEST_P(EveryTrackMethod, NothingRecordedGivesNoPose) { EXPECT_TRUE(make()->track({}).empty()); }

INSTANTIATE_TEST_SUITE_P(All, EveryTrackMethod,
                         ::testing::ValuesIn(track_methods().begin(), track_methods().end()),
                         [](const auto& method) { return std::string(method.param.name); });

}  // namespace
}  // namespace saccade
