#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include "simulator/sensor/event_options.h"
#include "simulator/sensor/noise/leak.h"
#include "simulator/sensor/noise/mismatch.h"
#include "simulator/sensor/noise/noise_models.h"
#include "simulator/sensor/noise/photoreceptor.h"
#include "simulator/sensor/noise/sensor_output.h"
#include "simulator/sensor/noise/spontaneous_events.h"

namespace saccade {
namespace {

constexpr std::uint16_t kSide = 16;

/// What a model does at a strength, and how to see it.
struct Contract {
  std::function<void(NoiseOptions&)> weak;  ///< strength 0, everything else stated
  std::function<void(NoiseOptions&)> strong;
  bool is_random = true;
};

const std::map<std::string_view, Contract>& contracts() {
  static const std::map<std::string_view, Contract> table = {
      {"mismatch",
       {[](NoiseOptions& o) { o.mismatch = {0}; }, [](NoiseOptions& o) { o.mismatch = {0.2}; }}},
      {"refractory",
       {[](NoiseOptions& o) { o.refractory = {0}; }, [](NoiseOptions& o) { o.refractory = {1000}; },
        false}},
      {"leak",
       {[](NoiseOptions& o) {
          o.leak = {0, 0.5};
        },
        [](NoiseOptions& o) {
          o.leak = {1, 0.5};
        }}},
      {"shot",
       {[](NoiseOptions& o) {
          o.shot = {0, 0.1, 1};
        },
        [](NoiseOptions& o) {
          o.shot = {10, 0.1, 1};
        }}},
      {"bandwidth",
       {[](NoiseOptions& o) {
          o.bandwidth = {0, 2, 1, 0.1, 1e4};
        },
        [](NoiseOptions& o) {
          o.bandwidth = {100, 2, 1, 0.1, 1e4};
        },
        false}},
      {"hot",
       {[](NoiseOptions& o) {
          o.hot = {0, 50, 0.5};
        },
        [](NoiseOptions& o) {
          o.hot = {0.5, 50, 0.5};
        }}},
      {"latency",
       {[](NoiseOptions& o) {
          o.latency = {0, 0};
        },
        [](NoiseOptions& o) {
          o.latency = {10, 5};
        }}},
      {"readout",
       {[](NoiseOptions& o) {
          o.readout = {0, false, 0};
        },
        [](NoiseOptions& o) {
          o.readout = {1e4, true, 100};
        },
        false}},
  };
  return table;
}

/// Everything that the models change in a small sensor: thresholds, blind time, slopes, spontaneous
/// events, the output for a step, and the recorded stream.
std::vector<double> traces(const NoiseOptions& noise, std::uint64_t seed) {
  EventOptions options;
  options.noise = noise;
  std::vector<double> traces = {noise.refractory.period_us};
  const SpontaneousEvents spontaneous(noise, options.log_eps, seed);
  SensedEvents events;
  for (std::uint16_t y = 0; y < kSide; ++y) {
    for (std::uint16_t x = 0; x < kSide; ++x) {
      const Contrast contrast =
          pixel_contrast(options.noise.mismatch, options.contrast, seed, x, y);
      traces.insert(traces.end(),
                    {contrast.on, contrast.off, leak_slope(noise.leak, contrast.on, seed, x, y)});
      SpontaneousState state = spontaneous.start(x, y, 0);
      while (state.next_s() < 2) {
        const SpontaneousCandidate candidate = spontaneous.next_candidate(state, x, y);
        if (spontaneous.accepts(candidate, -1))
          traces.insert(traces.end(), {candidate.t_s, 1.0 * candidate.polarity});
      }
      events.push_back({1'000'000, x, y, 1, EventOrigin::kSignal, -1});
    }
  }
  const PhotoreceptorFilter filter(noise.bandwidth, options.log_eps);
  traces.push_back(
      filter.on() ? filter.piece(PhotoreceptorFilter::settled(0), {0, 0.001, 1, 1}).value(0.001)
                  : 1);
  SensorOutput output(noise, kSide, kSide, 1000, seed);
  const auto sink = [&](std::span<const SensedEvent> piece) {
    for (const SensedEvent& e : piece)
      traces.insert(traces.end(), {static_cast<double>(e.t_ns), 1.0 * e.x, 1.0 * e.y});
  };
  output.push(events, 2'000'000, sink);
  output.finish(sink);
  return traces;
}

class NoiseModels : public ::testing::TestWithParam<NoiseModel> {};

TEST_P(NoiseModels, ZeroStrengthIsTheIdentityWhateverElseIsStated) {
  const Contract& contract = contracts().at(GetParam().name);
  NoiseOptions options;
  contract.weak(options);
  EXPECT_FALSE(GetParam().is_on(options));
  EXPECT_EQ(traces(options, 1), traces({}, 2));
}

TEST_P(NoiseModels, TheSeedRepeatsItAndAnotherSeedDoesNot) {
  const Contract& contract = contracts().at(GetParam().name);
  NoiseOptions options;
  contract.strong(options);
  EXPECT_TRUE(GetParam().is_on(options));
  EXPECT_TRUE(options.any());
  const std::vector<double> with_seed = traces(options, 1);
  EXPECT_NE(with_seed, traces({}, 1));
  EXPECT_EQ(with_seed, traces(options, 1));
  EXPECT_EQ(with_seed != traces(options, 2), contract.is_random);
}

INSTANTIATE_TEST_SUITE_P(All, NoiseModels,
                         ::testing::ValuesIn(noise_models().begin(), noise_models().end()),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace saccade
