#include "eval/metrics/sharpness.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/trajectory.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

constexpr int kWidth = 20, kHeight = 10;

/// A camera without distortion, and the truth if it is told: it stands still.
Dataset still_camera(const std::filesystem::path& folder, bool has_truth) {
  DatasetWriter writer(folder, {kWidth, kHeight, 20, 20, 9.5, 4.5, {}});
  writer.write_events(Events{{0, 1, 1, 1}});
  if (has_truth) writer.write_groundtruth(std::vector<StampedPose>{{0, {}}, {1, {}}});
  writer.finish({});
  return Dataset::open(folder);
}

/// In each window `events` pixels fired once, and the run put all of them on one pixel.
StabilizedRun gathered(const std::vector<int>& events) {
  StabilizedRun run;
  double start_s = 0;
  for (const int count : events) {
    for (int i = 0; i < count; ++i) {
      run.events.push_back({ns_from_seconds(start_s + 1e-4 * i), 3, 5, 1});
      run.coordinates.source_x.push_back(static_cast<std::uint16_t>(i % kWidth));
      run.coordinates.source_y.push_back(static_cast<std::uint16_t>(i / kWidth));
      run.coordinates.x.push_back(3);
      run.coordinates.y.push_back(5);
    }
    run.windows.push_back({start_s, start_s + 0.1, start_s, Eigen::Quaterniond::Identity()});
    start_s += 0.1;
  }
  return run;
}

/// Of an image of `pixels` of which `lit` are `value` and the others 0.
double variance(double pixels, double lit, double value) {
  return lit * value * value / pixels - lit * lit * value * value / (pixels * pixels);
}

TEST(Sharpness, IsTheVarianceOfTheImageOfEventsAndFwlItsGrowth) {
  const testing::TemporaryFolder folder;
  const Dataset dataset = still_camera(folder.path() / "data", true);
  const Metrics metrics = score_stabilization(gathered({40, 10}), dataset);
  constexpr double kPixels = kWidth * kHeight;
  const double raw[] = {variance(kPixels, 40, 1), variance(kPixels, 10, 1)};
  const double stabilized[] = {variance(kPixels, 1, 40), variance(kPixels, 1, 10)};
  EXPECT_NEAR(*metrics.get("sharpness.raw"), (raw[0] + raw[1]) / 2, 1e-9);
  EXPECT_NEAR(*metrics.get("sharpness.stabilized"), (stabilized[0] + stabilized[1]) / 2, 1e-9);
  EXPECT_NEAR(*metrics.get("sharpness.fwl"), (stabilized[0] / raw[0] + stabilized[1] / raw[1]) / 2,
              1e-9);
  EXPECT_NEAR(*metrics.get("sharpness.truth"), *metrics.get("sharpness.raw"), 1e-9);
  // The camera stood still: of the pixels that fired none is within a pixel of (3, 5).
  EXPECT_EQ(*metrics.get("stabilization.within_1px"), 0);
}

TEST(Sharpness, WindowsWithoutEventsSayNothingOfItsGrowth) {
  const testing::TemporaryFolder folder;
  const Dataset dataset = still_camera(folder.path() / "data", false);
  const Metrics one = score_stabilization(gathered({40}), dataset);
  const Metrics both = score_stabilization(gathered({40, 0}), dataset);
  EXPECT_EQ(*both.get("sharpness.fwl"), *one.get("sharpness.fwl"));
  EXPECT_FALSE(one.get("sharpness.truth"));
  EXPECT_FALSE(score_stabilization(gathered({0}), dataset).get("sharpness.fwl"));
}

}  // namespace
}  // namespace saccade
