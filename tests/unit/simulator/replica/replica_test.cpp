#include "simulator/replica/replica.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/config/config.h"
#include "core/random.h"
#include "simulator/replica/effective_contrast.h"
#include "simulator/replica/resimulation.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

using testing::TemporaryFolder;

/// A frame with gentle waves, seen by a camera that rotates about its y axis.
ReplicaSource waves() {
  ReplicaSource source;
  source.camera = {64, 48, 80, 80, 31.5, 23.5, {}};
  source.radiance = ImageF(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      source.radiance(x, y) =
          static_cast<float>(0.4 + 0.3 * std::sin(0.45 * x) * std::cos(0.3 * y + 0.2 * x));
  std::vector<StampedPose> poses;
  for (int k = 0; k <= 20; ++k)
    poses.push_back({5 + 0.01 * k, Rigid3(so3_exp({0, 0.004 * (k - 10), 0}), {0, 0, 0})});
  source.motion = Trajectory(poses);
  source.start_s = 5.05;
  source.duration_s = 0.1;
  return source;
}

Resimulation resimulation_of(const ReplicaSource& source) {
  const TemporaryFolder folder;
  write_replica(source, folder.path());
  return Resimulation(
      config::read<SimulationConfig>(config::load(folder.path() / "simulation.yaml")));
}

TEST(Replica, FiresWhatTheFrameShifts) {
  // The motion is 32 px/s at the centre, 3.2 px in all: a pixel's log intensity goes through the
  // frame's, between whose pixels cubic interpolation is exact to about (0.45 / 2)^4.
  const ReplicaSource source = waves();
  SensorParameters sensor;
  sensor.contrast_on = sensor.contrast_off = 0.05;
  const Resimulation resimulation = resimulation_of(source);
  EXPECT_NEAR(resimulation.duration_s(), 0.1, 1e-9);
  const SensedEvents events = resimulation.events(sensor);
  // One row of the frame by hand: the total variation that pixel x sees, in thresholds.
  const auto log_at = [&](double x, double y) {
    return std::log(1e-3 + 0.4 + 0.3 * std::sin(0.45 * x) * std::cos(0.3 * y + 0.2 * x));
  };
  double expected = 0, found = 0;
  for (int x = 20; x < 44; ++x) {
    double before = 0;
    for (int k = 0; k <= 200; ++k) {
      const double angle = 0.004 * (-5 + 10.0 * k / 200);
      const double seen = 31.5 + 80 * std::tan(std::atan((x - 31.5) / 80) + angle);
      const double value = log_at(seen, 24);
      if (k > 0) expected += std::abs(value - before) / 0.05;
      before = value;
    }
  }
  for (const SensedEvent& event : events)
    if (event.y == 24 && event.x >= 20 && event.x < 44) found += 1;
  // A pixel loses less than one threshold at its end, and one at each turn of its signal: of 24
  // pixels that turn once at most, 0 to 48, about half of that.
  EXPECT_LT(found, expected);
  EXPECT_GT(found, expected - 48);
  EXPECT_GT(expected, 200);
}

TEST(Replica, ComparesOnlyWhatTheFrameShows) {
  const ReplicaSource source = waves();
  const ImageU8 comparable = comparable_pixels(source, 0);
  EXPECT_EQ(comparable(32, 24), 1);
  // 0.02 rad to each side are 1.6 px at the centre and a fifth more at the border.
  EXPECT_EQ(comparable(1, 24), 0);
  EXPECT_EQ(comparable(62, 24), 0);
  EXPECT_EQ(comparable(4, 24), 1);
}

TEST(Replica, IsTheSameThroughALens) {
  // The frame of a lens, hung straight: what a pixel sees at the frame's own pose is its own value.
  ReplicaSource source = waves();
  source.camera.distortion = {-0.2, 0.05, 0, 0, 0};
  SensorParameters sensor;
  sensor.contrast_on = sensor.contrast_off = 0.05;
  const Resimulation lens = resimulation_of(source);
  const SensedEvents events = lens.events(sensor);
  ASSERT_FALSE(events.empty());
  int compared = 0;
  for (const SensedEvent& event : events) {
    const double t_s = 5.05 + seconds_from_ns(event.t_ns);
    if (std::abs(t_s - 5.1) > 2e-4 || event.x < 4 || event.x > 59 || event.y < 4 || event.y > 43)
      continue;
    const double value = std::log(1e-3 + source.radiance(event.x, event.y));
    EXPECT_NEAR(event.log_intensity, value, 0.02);
    ++compared;
  }
  EXPECT_GT(compared, 3);
}

TEST(FrameNoise, IsThatOfTheFlattestParts) {
  ImageF frame(100, 100, 0.5F);
  const Random random(3);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const auto i = static_cast<std::uint64_t>(y * 100 + x);
      frame(x, y) += static_cast<float>(0.01 * random.normal(1, i));
      if (x > 50) frame(x, y) += static_cast<float>(0.2 * std::sin(x));
    }
  // The 5 % quantile of the standard deviations of 25 samples is 24 % below the true one.
  EXPECT_NEAR(frame_noise(frame), 0.008, 0.002);
}

TEST(ContrastSums, AreTheThresholdsOfAnIdealPixel) {
  SensorParameters sensor;
  sensor.contrast_on = 0.06;
  sensor.contrast_off = 0.04;
  const SensedEvents events = resimulation_of(waves()).events(sensor);
  const ContrastSums all = contrast_sums(events, {64, 48});
  ASSERT_TRUE(all.mean_on() && all.mean_off());
  // After an event of the other polarity the change is the threshold, too: from reference to
  // reference. So it is exactly the threshold everywhere.
  EXPECT_NEAR(*all.mean_on(), 0.06, 0.002);
  EXPECT_NEAR(*all.mean_off(), 0.04, 0.002);
}

TEST(ContrastSums, AreEmptyWithoutEvents) { EXPECT_FALSE(contrast_sums({}, {4, 4}).mean_on()); }

}  // namespace
}  // namespace saccade
