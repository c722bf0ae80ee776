#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulator/sensor/pixel/pixel_sensor.h"
#include "simulator/sensor/signal/linear_signal.h"
#include "simulator/sensor/signal/texture_signal.h"
#include "tests/support/meshes.h"

namespace saccade {
namespace {

constexpr double kFilterEps = 0.01;
constexpr double kTolerance_s = 1e-6;

struct FilteredEvent {
  double t_s;
  int polarity;
};

/// A pixel behind a low pass, and what it fires.
class FilteredPixel {
 public:
  explicit FilteredPixel(double log_intensity)
      : noise_(options(), 1),
        traits_{0, 0, {0.1, 0.12}, 0.2},
        state_(start_pixel(traits_, log_intensity, 0)),
        thresholds_(state_.reference.band(), traits_.drift_per_s, kFilterEps),
        noisy_(noise_.start(0, 0, log_intensity, 0)) {}

  template <class Signal>
  void sense(const Signal& signal, const typename Signal::Sample& from,
             const typename Signal::Sample& to) {
    const auto emit = [&](double t_s, int polarity, EventOrigin, double) {
      events_.push_back({t_s, polarity});
    };
    PixelSensor sensor(signal, traits_, kFilterEps, state_, thresholds_, emit);
    sensor.sense_filtered(from, to, noise_, noisy_);
  }

  [[nodiscard]] const std::vector<FilteredEvent>& events() const { return events_; }

 private:
  static EventOptions options() {
    EventOptions options;
    options.log_eps = kFilterEps;
    options.noise.bandwidth.cutoff_hz = 800;
    options.noise.bandwidth.order = 2;
    return options;
  }

  PixelNoise noise_;
  PixelTraits traits_;
  PixelState state_;
  Thresholds thresholds_;
  NoisyState noisy_;
  std::vector<FilteredEvent> events_;
};

TexelTrajectory filtered_path(double length_s) {
  return {{3.2, 8.8, 7.5, 8.4, 11.6, 8}, {8.3, -4.4, 6.15, -4.2, 4.1, -4}, 0, length_s};
}

// Along the lines of a texture the same happens as along a hundred thousand straight pieces, whether
// the low pass forgets within a cell (0.4 s) or remembers several (0.01 s).
TEST(FilteredTexture, FiresAsBehindAFilterOfShortPieces) {
  const Texture texture(testing::patches(16, 12, 5));
  for (const double length_s : {0.01, 0.4}) {
    SCOPED_TRACE(length_s);
    const TexelTrajectory path = filtered_path(length_s);
    const TextureSignal signal(path, {&texture, 0, 0, 0.7}, kFilterEps, kTolerance_s);
    const TrajectorySample from = signal.sample_at(0, true);
    FilteredPixel pixel(from.log_intensity);
    pixel.sense(signal, from, signal.sample_at(length_s, true));

    FilteredPixel dense(from.log_intensity);
    const LinearSignal lines(kFilterEps, kTolerance_s);
    constexpr int kPieces = 100000;
    LinearSample last{0, from.log_intensity};
    for (int k = 1; k <= kPieces; ++k) {
      const double t_s = length_s * k / kPieces;
      const LinearSample next{t_s, signal.sample_at(t_s, true).log_intensity};
      dense.sense(lines, last, next);
      last = next;
    }

    ASSERT_GE(dense.events().size(), 4U);
    ASSERT_EQ(pixel.events().size(), dense.events().size());
    for (std::size_t k = 0; k < dense.events().size(); ++k) {
      EXPECT_EQ(pixel.events()[k].polarity, dense.events()[k].polarity) << k;
      EXPECT_NEAR(pixel.events()[k].t_s, dense.events()[k].t_s, 2e-3 * length_s) << k;
    }
  }
}

}  // namespace
}  // namespace saccade
