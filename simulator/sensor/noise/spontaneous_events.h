#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/random.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {
namespace config {
class Fields;
}
struct NoiseOptions;

/// Shot noise: a Poisson process per pixel, ON and OFF equally likely, whose rate falls from
/// rate_hz in the dark linearly with the radiance to bright_fraction of it (v2e, Hu et al. 2021;
/// measured by Graca et al., "Shining light on the DVS pixel", 2023):
///   rate(I) = rate_hz (1 - (1 - bright_fraction) min(1, I / bright_radiance))
struct ShotOptions {
  double rate_hz = 0;
  double bright_fraction = 0.25;  ///< of the rate, that remains at bright_radiance and above
  double bright_radiance = 1;

  [[nodiscard]] bool on() const { return rate_hz > 0; }
};
void describe(config::Fields& fields, ShotOptions& options);

/// Pixels whose leaking junctions fire by themselves: a Poisson process of ON events per hot pixel,
///   rate_p = rate_hz exp(sigma z),   z ~ N(0, 1), one draw per pixel
/// The heavy tail is what noise histograms of real sensors show (Joubert et al., Frontiers in
/// Neuroscience 15, 2021).
struct HotOptions {
  double fraction = 0;
  double rate_hz = 100;
  double sigma = 0.5;

  [[nodiscard]] bool on() const { return fraction > 0 && rate_hz > 0; }
};
void describe(config::Fields& fields, HotOptions& options);

/// A time at which a pixel may fire without a crossing.
struct SpontaneousCandidate {
  double t_s = 0;
  int polarity = 1;
  double thinning = 0;  ///< uniform in [0, 1)
  EventOrigin origin = EventOrigin::kShot;
};

/// Where a pixel's processes stand; trivially copyable, without padding.
struct SpontaneousState {
  std::uint64_t shots = 0;  ///< candidates drawn so far
  std::uint64_t hots = 0;
  double next_shot_s = std::numeric_limits<double>::infinity();
  double next_hot_s = std::numeric_limits<double>::infinity();

  /// Time of the pixel's next candidate; infinity: there is none.
  [[nodiscard]] double next_s() const { return std::min(next_shot_s, next_hot_s); }
};

/// Shot noise and hot pixels (formulas at ShotOptions and HotOptions) in continuous time: every
/// pixel has a homogeneous Poisson process at each model's greatest rate, and a candidate is kept
/// with the probability rate(I(t)) / greatest rate (thinning; Lewis and Shedler, Naval Research
/// Logistics 26, 1979). So the events depend on the seed, the pixel and the signal at the
/// candidates' own times, never on the times at which the signal is sampled. Thread-safe.
class SpontaneousEvents {
 public:
  /// `log_eps`: eps of L = ln(eps + I).
  SpontaneousEvents(const NoiseOptions& options, double log_eps, std::uint64_t seed);

  [[nodiscard]] bool on() const { return shot_.on() || hot_.on(); }

  /// The processes of a pixel from `t_s` on.
  [[nodiscard]] SpontaneousState start(std::uint16_t x, std::uint16_t y, double t_s) const;
  /// The candidate at state.next_s(), which must be finite; moves the state behind it.
  SpontaneousCandidate next_candidate(SpontaneousState& state, std::uint16_t x,
                                      std::uint16_t y) const;
  /// Whether the pixel fires at the candidate. `log_intensity`: of the signal at its time.
  [[nodiscard]] bool accepts(const SpontaneousCandidate& candidate, double log_intensity) const;

  /// Rate of the shot noise at a log intensity [1/s].
  [[nodiscard]] double shot_rate_hz(double log_intensity) const;
  /// Rate of a pixel's hot events [1/s]; 0 when it is not hot.
  [[nodiscard]] double hot_rate_hz(std::uint16_t x, std::uint16_t y) const;

 private:
  /// Time between the candidates `index` - 1 and `index` of a process.
  [[nodiscard]] double gap_s(std::uint64_t stream, std::uint64_t index, double rate_hz) const;

  ShotOptions shot_;
  HotOptions hot_;
  double log_eps_;
  Random random_;
};

}  // namespace saccade
