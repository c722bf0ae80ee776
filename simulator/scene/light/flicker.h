#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/config/fields.h"

namespace saccade {

/// The form of a flicker over its period.
enum class Waveform {
  kSine,    ///< a sine around the mean
  kMains,   ///< a rectified sine: two half waves per period of the mains, with kinks at its zeros
  kSquare,  ///< pulse width modulation: on, then off
};

/// How a light varies with time (section `flicker` of a light).
struct FlickerOptions {
  double frequency_hz = 100;  ///< of the flicker itself: twice that of the mains
  Waveform waveform = Waveform::kSine;
  double depth = 1;      ///< 0: steady, 1: at its darkest the light is off
  double duty = 0.5;     ///< fraction of a period in which a square wave is on
  double phase_deg = 0;  ///< of the period, at time 0
  bool operator==(const FlickerOptions&) const = default;
};

/// Bounds of a quantity of light, and of its rate of change, over an interval of time.
struct LightRange {
  double low = 1, high = 1;
  double rate_low = 0, rate_high = 0;  ///< [1/s]; infinite around a jump

  void add(const LightRange& other);
  /// Of both ranges' quantities one or the other.
  void include(const LightRange& other);
  /// Of the product of two quantities, neither negative.
  [[nodiscard]] LightRange times(const LightRange& other) const;
};

/// The factor of a flickering light, a closed form of time with mean 1 over the period. With the
/// phase x = t * frequency + phase / 360 deg and frac(x) = x - floor(x):
///   sine    1 + depth sin(2 pi x)
///   mains   1 - depth + depth pi/2 |sin(pi x)|
///   square  1 - depth + (frac(x) < duty ? depth / duty : 0)
class Flicker {
 public:
  explicit Flicker(const FlickerOptions& options);

  [[nodiscard]] double at(double t_s) const;
  /// The mean over `span_s` >= 0 around `t_s`, in closed form.
  [[nodiscard]] double mean(double t_s, double span_s) const;
  [[nodiscard]] LightRange range(double from_s, double to_s) const;

  /// The first time after `from_s` and before `to_s` at which the factor jumps.
  [[nodiscard]] std::optional<double> first_jump(double from_s, double to_s) const;
  /// The times between both ends at which it jumps or turns: between two of them it is smooth and
  /// monotone. Of a jump there is a time `around_s` before it and one after it.
  void find_breaks(double from_s, double to_s, double around_s, std::vector<double>& times_s) const;

  [[nodiscard]] double period_s() const { return 1 / options_.frequency_hz; }
  [[nodiscard]] const FlickerOptions& options() const { return options_; }

 private:
  [[nodiscard]] double phase(double t_s) const {
    return t_s * options_.frequency_hz + options_.phase_deg / 360;
  }
  [[nodiscard]] double time_of(double phase) const {
    return (phase - options_.phase_deg / 360) / options_.frequency_hz;
  }
  /// The factor's integral over the phase, but for a constant.
  [[nodiscard]] double integral(double phase) const;
  /// The jumps of a square wave up to a phase, from that of phase 0 on.
  [[nodiscard]] double jumps_until(double phase) const;
  [[nodiscard]] double phase_of_jump(double index) const;

  FlickerOptions options_;
};

/// Of all of some flickers: the first jump, if any.
[[nodiscard]] std::optional<double> first_jump(std::span<const Flicker> flickers, double from_s,
                                               double to_s);
/// Of the fastest one; infinite where there is none.
[[nodiscard]] double shortest_period_s(std::span<const Flicker> flickers);

void describe(config::Fields& fields, FlickerOptions& options);

}  // namespace saccade
