#include "estimator/imu/turning_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/io/imu_file.h"
#include "core/random.h"
#include "tests/support/recording.h"
#include "tests/support/shared_folder.h"

namespace saccade {
namespace {

const PinholeCamera kTurningCamera{120, 90, 100, 100, 59.5, 44.5, {}};

/// 300 dots that a camera sees which turns by `rate_rad_s` about its y axis (all that it sees moves
/// to the left), each with an event whenever it comes to another pixel, and `noise` events anywhere.
Events seen(double rate_rad_s, double duration_s, int noise, std::uint64_t seed) {
  const Random random(seed);
  Events events;
  const auto add = [&](double t_s, double x, double y) {
    if (x >= 0 && x < kTurningCamera.width && y >= 0 && y < kTurningCamera.height)
      events.push_back(
          {ns_from_seconds(t_s), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1});
  };
  constexpr int kDots = 300;
  for (std::uint64_t k = 0; k < kDots; ++k) {
    const double x = kTurningCamera.width * random.uniform(1, k);
    const double y = kTurningCamera.height * random.uniform(2, k);
    int last = static_cast<int>(std::floor(x));
    for (double t_s = 0; t_s < duration_s; t_s += 1e-3) {
      const double now = x - kTurningCamera.fx * rate_rad_s * t_s;
      const int column = static_cast<int>(std::floor(now));
      if (column != last) add(t_s, now, y);
      last = column;
    }
  }
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(noise); ++k)
    add(duration_s * random.uniform(3, k), kTurningCamera.width * random.uniform(4, k),
        kTurningCamera.height * random.uniform(5, k));
  std::ranges::sort(events, {}, &Event::t_ns);
  return events;
}

bool show_turn(const Events& events, double rate_rad_s) {
  TurningEvents turning(kTurningCamera, {0, rate_rad_s, 0}, ns_from_seconds(0.2));
  turning.add(events);
  return turning.show_turn();
}

TEST(TurningEvents, ShowTheTurnThatTheGyroscopeReads) {
  EXPECT_TRUE(show_turn(seen(0.15, 0.4, 500, 1), 0.15));
  EXPECT_TRUE(show_turn(seen(-0.15, 0.4, 500, 1), -0.15));
  // The bias is as large as the turn.
  EXPECT_TRUE(show_turn(seen(0.1, 0.4, 500, 1), 0.2));
}

TEST(TurningEvents, ShowNoneAtRestOrTheOtherWay) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_FALSE(show_turn(seen(0, 0.4, 600, seed), 0.15)) << seed;
  EXPECT_FALSE(show_turn(seen(-0.15, 0.4, 0, 1), 0.15));
}

TEST(TurningEvents, AHotPixelAndFewEventsTellNothing) {
  Events events = seen(0, 0.4, 600, 1);
  for (int k = 0; k < 4000; ++k) events.push_back({ns_from_seconds(0.1 + 5e-5 * k), 60, 40, 1});
  std::ranges::sort(events, {}, &Event::t_ns);
  EXPECT_FALSE(show_turn(events, 0.15));
  EXPECT_FALSE(show_turn(Events(events.begin(), events.begin() + 100), 0.15));
  EXPECT_FALSE(show_turn({}, 0.15));
}

/// A dataset of three times 0.4 s: a pan, rest and a pan, all of which the gyroscope reads as 0.15
/// rad/s.
class MarkTurns : public testing::SharedFolder<MarkTurns> {
 public:
  static void fill() {
    Events events;
    for (const int part : {0, 1, 2})
      for (Event event : seen(part == 1 ? 0 : 0.15, 0.4, 600, 7)) {
        event.t_ns += part * ns_from_seconds(0.4);
        events.push_back(event);
      }
    const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
    testing::write_recording(path("pan"), kTurningCamera, events,
                             {{{0, ImageU8(kTurningCamera.width, kTurningCamera.height)}}},
                             {{{0, {upright, {0, 0, 0}}}, {1.2, {upright, {0, 0, 0}}}}});
    std::vector<ImuSample> samples;
    for (int i = 0; i < 1200; ++i)
      samples.push_back({ns_from_seconds(1e-3 * i), {0, -9.81, 0}, {0, 0.15, 0}});
    write_imu(path("pan") / "imu.txt", samples);
  }
};

TEST_F(MarkTurns, TellsPansFromRest) {
  const Dataset dataset = Dataset::open(path("pan"));
  ImuInput imu = load_imu_input(dataset, "this test");
  mark_turns(imu, dataset);
  for (std::size_t i = 0; i < imu.samples.size(); ++i)
    EXPECT_EQ(imu.samples[i].may_rest, i >= 400 && i < 800) << i;
}

}  // namespace
}  // namespace saccade
