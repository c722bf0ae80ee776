#include "simulator/sensor/noise/sensor_output.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "core/random.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/sensor/noise/log_eps.h"
#include "tests/unit/simulator/sensor/noise/statistics.h"

namespace saccade {
namespace {

using testing::error_of;
using testing::kLogEps;

constexpr int kOutputWidth = 40;
constexpr int kOutputHeight = 30;
constexpr std::uint64_t kOutputSeed = 5;
constexpr TimeNs kStep_ns = 1000;

/// `count` events at random pixels of the sensor, at Poisson times of `rate_hz`, in whole steps.
SensedEvents random_events(std::size_t count, double rate_hz, TimeNs step_ns = kStep_ns) {
  const Random random(99);
  SensedEvents events;
  double t_ns = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    t_ns -= 1e9 * std::log1p(-random.uniform(0, i)) / rate_hz;
    SensedEvent event;
    event.t_ns = step_ns * std::llround(t_ns / static_cast<double>(step_ns));
    event.x = static_cast<std::uint16_t>(random.below(kOutputWidth, 1, i));
    event.y = static_cast<std::uint16_t>(random.below(kOutputHeight, 2, i));
    event.polarity = random.uniform(3, i) < 0.5 ? 1 : -1;
    event.log_intensity = static_cast<float>(random.uniform(4, i) - 1);
    events.push_back(event);
  }
  std::ranges::sort(events, SensedEventOrder{});
  return events;
}

SensorOutput make_output(const NoiseOptions& options, TimeNs step_ns = kStep_ns,
                         std::uint64_t seed = kOutputSeed) {
  return {options, kOutputWidth, kOutputHeight, step_ns, seed};
}

/// Pushes `events` in pieces of `chunk`, each complete up to a bit less than its next event, which
/// is no multiple of the step.
SensedEvents record(SensorOutput& output, const SensedEvents& events, std::size_t chunk) {
  SensedEvents recorded;
  const auto sink = [&](std::span<const SensedEvent> piece) {
    recorded.insert(recorded.end(), piece.begin(), piece.end());
  };
  for (std::size_t i = 0; i < events.size(); i += chunk) {
    const std::size_t end = std::min(events.size(), i + chunk);
    const TimeNs next_ns = end < events.size() ? events[end].t_ns : events.back().t_ns + kStep_ns;
    const TimeNs complete_ns = next_ns - 7 * kStep_ns / 10;
    output.push(std::span(events).subspan(i, end - i), complete_ns, sink);
  }
  output.finish(sink);
  return recorded;
}

SensedEvents record(const NoiseOptions& options, const SensedEvents& events,
                    std::size_t chunk = 1000) {
  SensorOutput output = make_output(options);
  return record(output, events, chunk);
}

NoiseOptions busy_options() {
  NoiseOptions options;
  options.latency = {50, 15};
  options.readout = {1.7e5, true, 50};
  return options;
}

TEST(SensorOutput, WithoutModelsIsTheIdentity) {
  const SensedEvents events = random_events(5000, 1e6);
  EXPECT_EQ(record({}, events), events);
}

TEST(SensorOutput, IsSortedAndIndependentOfTheCallsAndOfSaving) {
  const SensedEvents events = random_events(20000, 3e5);
  for (const bool rows : {false, true}) {
    NoiseOptions options = busy_options();
    options.readout.rows = rows;
    SensorOutput whole = make_output(options);
    const SensedEvents recorded = record(whole, events, events.size());
    EXPECT_TRUE(std::ranges::is_sorted(recorded, SensedEventOrder{}));
    EXPECT_GT(whole.lost(), 0U);
    EXPECT_EQ(recorded.size() + whole.lost(), events.size());
    EXPECT_EQ(whole.recorded(), recorded.size());
    EXPECT_EQ(record(options, events, 1), recorded);
    EXPECT_EQ(record(options, events, 777), recorded);

    SensedEvents resumed;
    const auto sink = [&](std::span<const SensedEvent> piece) {
      resumed.insert(resumed.end(), piece.begin(), piece.end());
    };
    SensorOutput first = make_output(options);
    first.push(std::span(events).first(7000), events[7000].t_ns, sink);
    SensorOutput second = make_output(options);
    second.load(first.state());
    EXPECT_EQ(second.state().size(), first.state().size());
    second.push(std::span(events).subspan(7000), events.back().t_ns + 1, sink);
    second.finish(sink);
    EXPECT_EQ(resumed, recorded);
    EXPECT_EQ(second.lost(), whole.lost());
  }
}

TEST(SensorOutput, RefusesAStateThatDoesNotFit) {
  SensorOutput output = make_output(busy_options());
  const std::string state = output.state();
  EXPECT_NE(error_of([&] { output.load(state.substr(0, state.size() - 1)); }), "no error");
  EXPECT_NE(error_of([&] { output.load(state + "x"); }), "no error");
  SensorOutput other(busy_options(), kOutputWidth + 1, kOutputHeight, kStep_ns, kOutputSeed);
  EXPECT_NE(error_of([&] { other.load(state); }), "no error");
}

/// One event per pixel, far apart in time, with the latency that the output gives it [us].
std::vector<double> latencies_us(const LatencyOptions& latency, std::size_t count) {
  NoiseOptions options;
  options.latency = latency;
  SensedEvents events;
  for (std::size_t i = 0; i < count; ++i) {
    SensedEvent event;
    event.t_ns = static_cast<TimeNs>(i) * 10'000'000;
    event.x = static_cast<std::uint16_t>(i % kOutputWidth);
    event.y = static_cast<std::uint16_t>(i / kOutputWidth % kOutputHeight);
    events.push_back(event);
  }
  SensorOutput output = make_output(options, 1);
  const SensedEvents recorded = record(output, events, 100);
  std::vector<double> latencies;
  for (std::size_t i = 0; i < count; ++i)
    latencies.push_back(1e-3 * static_cast<double>(recorded[i].t_ns - events[i].t_ns));
  return latencies;
}

TEST(Latency, WithoutJitterIsItsMean) { EXPECT_NEAR(latencies_us({10, 0}, 1)[0], 10, 2e-3); }

TEST(Latency, JitterIsNormal) {
  constexpr std::size_t kCount = 20000;
  const std::vector<double> latencies = latencies_us({100, 12}, kCount);
  constexpr int kBins = 30;
  std::array<double, kBins> bins{};
  for (const double latency : latencies) {
    ASSERT_GE(latency, 100 - 4 * 12);
    ASSERT_LE(latency, 100 + 4 * 12);
    const double share = normal_share_below((latency - 100) / 12);
    ++bins[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(kBins * share)))];
  }
  const double expected = static_cast<double>(kCount) / kBins;
  double chi_square = 0;
  for (const double bin : bins) chi_square += (bin - expected) * (bin - expected) / expected;
  EXPECT_LT(chi_square, chi_square_bound(kBins - 1, kSigmas));
}

TEST(Latency, IsNeverNegative) {
  const std::vector<double> latencies = latencies_us({0, 12}, 2000);
  const auto zeros = static_cast<double>(std::ranges::count(latencies, 0.0));
  EXPECT_NEAR(zeros, 1000, kSigmas * std::sqrt(500.0));
  EXPECT_GE(std::ranges::min(latencies), 0);
}

TEST(Latency, KeepsTheOrderOfEveryPixel) {
  NoiseOptions options;
  options.latency = {10, 200};
  const SensedEvents events = random_events(20000, 2e6);
  using Pixel = std::pair<int, int>;
  std::map<Pixel, std::vector<int>> fired;
  std::map<Pixel, std::vector<int>> received;
  for (const SensedEvent& e : events) fired[{e.x, e.y}].push_back(e.polarity);
  for (const SensedEvent& e : record(options, events)) received[{e.x, e.y}].push_back(e.polarity);
  // Events of both polarities at one time stand in the stream's order, whichever fired first.
  EXPECT_EQ(fired, received);
}

NoiseOptions readout(double rate_hz, bool rows, std::int64_t capacity) {
  NoiseOptions options;
  options.readout = {rate_hz, rows, capacity};
  return options;
}

TEST(Readout, LeavesARareEventAlone) {
  SensedEvents events = random_events(200, 100);
  EXPECT_EQ(record(readout(1e6, false, 1), events), events);
}

TEST(Readout, EventsOfOneStampAreOrderedHoweverTheStreamIsCut) {
  // Bursts every 5 us keep a bus busy that sends three events per microsecond.
  const SensedEvents events = random_events(20000, 2.7e6, 5000);
  const SensedEvents recorded = record(readout(3e6, false, 0), events, events.size());
  EXPECT_TRUE(std::ranges::is_sorted(recorded, SensedEventOrder{}));
  EXPECT_EQ(record(readout(3e6, false, 0), events, 1), recorded);
}

TEST(Readout, ServesABurstAtItsRateAndLosesWhatFindsNoPlace) {
  SensedEvents events(100);
  for (std::size_t i = 0; i < events.size(); ++i) {
    events[i].t_ns = 5'000'000;
    events[i].x = static_cast<std::uint16_t>(i % kOutputWidth);
    events[i].y = static_cast<std::uint16_t>(i / kOutputWidth);
  }
  SensorOutput output = make_output(readout(1e5, false, 60));
  const SensedEvents recorded = record(output, events, 100);
  ASSERT_EQ(recorded.size(), 60U);
  EXPECT_EQ(output.lost(), 40U);
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    EXPECT_EQ(recorded[i].t_ns, 5'000'000 + static_cast<TimeNs>(i) * 10'000);
    EXPECT_EQ(recorded[i].x, events[i].x);
  }
}

TEST(Readout, RowsLeaveTogether) {
  const std::array<std::pair<TimeNs, int>, 5> requests = {
      {{1000, 7}, {1000, 7}, {2000, 3}, {3000, 7}, {4000, 3}}};
  SensedEvents events(requests.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    events[i].t_ns = requests[i].first;
    events[i].x = static_cast<std::uint16_t>(i);
    events[i].y = static_cast<std::uint16_t>(requests[i].second);
  }
  // 10 us an event: row 7 at 1 us, both events of row 3 at 21 us, row 7 again at 41 us.
  const SensedEvents recorded = record(readout(1e5, true, 0), events);
  ASSERT_EQ(recorded.size(), events.size());
  const std::array<std::pair<TimeNs, int>, 5> expected = {
      {{1000, 0}, {1000, 1}, {21'000, 2}, {21'000, 4}, {41'000, 3}}};
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(recorded[i].t_ns, expected[i].first);
    EXPECT_EQ(recorded[i].x, expected[i].second);
  }
}

/// Waiting times of a queue with Poisson arrivals and constant service: rho / (2 mu (1 - rho)) on
/// average (Pollaczek-Khinchine).
TEST(Readout, WaitsLikeAQueueWithConstantService) {
  constexpr double kRate_hz = 1e5;
  constexpr double kLoad = 0.6;
  const SensedEvents events = random_events(200000, kLoad * kRate_hz, 1);
  SensorOutput output = make_output(readout(kRate_hz, false, 0), 1);
  const SensedEvents recorded = record(output, events, 5000);
  ASSERT_EQ(recorded.size(), events.size());
  // Waiting times of neighbours are correlated; means over blocks of 1000 hardly are.
  std::vector<double> blocks(200);
  for (std::size_t i = 0; i < events.size(); ++i)
    blocks[i / 1000] += 1e-9 * static_cast<double>(recorded[i].t_ns - events[i].t_ns) / 1000;
  const Moments moments = moments_of(blocks);
  EXPECT_NEAR(moments.mean, kLoad / (2 * kRate_hz * (1 - kLoad)),
              kSigmas * std::sqrt(moments.variance / 200));
}

TEST(Readout, OverloadedBusSendsAtItsRateAndLosesTheRest) {
  for (const bool rows : {false, true}) {
    const SensedEvents events = random_events(50000, 3e5);
    SensorOutput output = make_output(readout(1e5, rows, 100));
    const SensedEvents recorded = record(output, events, 1000);
    const double duration_s = seconds_from_ns(recorded.back().t_ns - recorded.front().t_ns);
    // The queue is never empty, so nothing but the first and the last service is left to chance.
    EXPECT_NEAR(static_cast<double>(recorded.size()), 1e5 * duration_s, 101) << rows;
    EXPECT_EQ(recorded.size() + output.lost(), events.size());
  }
}

}  // namespace
}  // namespace saccade
