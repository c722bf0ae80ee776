#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/check.h"

namespace saccade {

/// A log intensity that is linear from (t0_s, start) to (t1_s, end), t0_s <= t1_s.
struct LinearPiece {
  double t0_s = 0;
  double t1_s = 0;
  double start = 0;
  double end = 0;
};

/// Outputs of a low pass's stages [log units]. Trivially copyable, without padding.
struct FilterState {
  double first = 0;   ///< of the first of two stages; equals `output` when there is one
  double output = 0;  ///< what the pixel compares with its reference
};

/// 1 - e^-a of a >= 0, to a few units of the last place. The library's expm1 takes three times as
/// long as its exp, and half of a noisy simulation's time was in it.
[[nodiscard]] inline double exponential_rise(double a) {
  // From here on the difference loses no more than a bit; below, Taylor's series is exact enough
  // with this many terms.
  constexpr double kLargest = 0.5;
  if (a > kLargest) return 1 - std::exp(-a);
  constexpr std::array<double, 13> kInverse = [] {
    std::array<double, 13> inverse{};
    double factorial = 1;
    for (std::size_t k = 0; k < inverse.size(); ++k) {
      factorial *= static_cast<double>(k + 2);
      inverse[k] = (k % 2 == 0 ? -1 : 1) / factorial;
    }
    return inverse;
  }();
  // a + a^2 (c0 + c1 a + c2 a^2 + ...), in pairs that do not wait for each other.
  const double square = a * a;
  const double fourth = square * square;
  const double eighth = fourth * fourth;
  const auto pair = [&](std::size_t k) { return kInverse[k] + kInverse[k + 1] * a; };
  const auto four = [&](std::size_t k) { return pair(k) + pair(k + 2) * square; };
  const double sum = (four(0) + four(4) * fourth) + (four(8) + kInverse[12] * fourth) * eighth;
  return a + square * sum;
}

/// Where a signal leaves the band.
struct FilterCrossing {
  double t_s = 0;    ///< at most the tolerance after the exact time, never before it
  int polarity = 1;  ///< +1: through the upper level
};

/// The output of a low pass with one pole or two equal ones over a linear piece of its input, in
/// closed form. With a = w (t - t0), the input x0 + s (t - t0), and the stages y1, y at first:
///   order 1: y = y0 + (x0 - y0)(1 - e^-a) + s (t - t0)(1 - (1 - e^-a) / a)
///   order 2: y = y0 + (x0 - y0)(1 - e^-a) + (y1_0 - x0) a e^-a
///                + s (t - t0)(1 + e^-a - 2 (1 - e^-a) / a)
/// Exact to rounding for a from 0 to beyond 1e6.
class FilteredPiece {
 public:
  /// `rate`: w > 0 [1/s]; `order`: 1 or 2. Of a piece of no length only the state remains.
  FilteredPiece(const FilterState& state, const LinearPiece& input, double rate, int order)
      : state_(state),
        t0_s_(input.t0_s),
        duration_s_(input.t1_s - input.t0_s),
        input_(input.start),
        slope_(duration_s_ > 0 ? (input.end - input.start) / duration_s_ : 0),
        rate_(rate),
        order_(order),
        whole_(elapsed(duration_s_, rate)) {
    SACCADE_CHECK(duration_s_ >= 0 && rate > 0 && (order == 1 || order == 2));
    if (order == 1) state_.first = state_.output;
  }

  /// At a time of the piece.
  [[nodiscard]] double value(double t_s) const { return value_after(after(t_s - t0_s_)); }
  [[nodiscard]] FilterState state(double t_s) const { return state_after(after(t_s - t0_s_)); }
  /// What the next piece is entered with.
  [[nodiscard]] FilterState end_state() const { return state_after(whole_); }

  /// The lowest and the highest value between which the output provably stays. Every stage averages
  /// its input with positive weights, so within the hull [l, h] of the first stage and the input
  ///   y0 + min(0, l - y0)(1 - e^-a) <= y <= y0 + max(0, h - y0)(1 - e^-a)   with a of the end.
  [[nodiscard]] std::pair<double, double> bounds() const {
    const double end = input_ + slope_ * duration_s_;
    const double low = std::min(std::min(state_.first, state_.output), std::min(input_, end));
    const double high = std::max(std::max(state_.first, state_.output), std::max(input_, end));
    return {state_.output + (low - state_.output) * whole_.rise,
            state_.output + (high - state_.output) * whole_.rise};
  }

  /// The times inside the piece at which the output has an extremum, ascending; at most 1 for order
  /// 1, at most 2 for order 2.
  struct Extrema {
    std::array<double, 2> t_s;
    int count = 0;
  };
  [[nodiscard]] Extrema extrema() const;

  /// The first time from `from_s` to the piece's end at which the output is not between `lower` and
  /// `upper`; `from_s` itself where it is outside already. Rigorous: between two extrema the output
  /// is monotonic, so it crosses at most once and its end tells.
  [[nodiscard]] std::optional<FilterCrossing> first_crossing(double lower, double upper,
                                                             double from_s,
                                                             double tolerance_s) const;

  /// The output plus slope * (t - t0), again as a filtered piece: how a pixel with a leaking
  /// reference sees it when the band is that of t0.
  [[nodiscard]] FilteredPiece drifting(double slope) const;

 private:
  /// A time since t0 and what the stages have forgotten by then.
  struct Elapsed {
    double tau_s;
    double a;           ///< w tau
    double rise;        ///< 1 - e^-a
    double mean_decay;  ///< (1 - e^-a) / a

    /// e^-a, to within a rounding error of 1.
    [[nodiscard]] double decay() const { return 1 - rise; }
  };
  static constexpr Elapsed kStart{0, 0, 0, 1};
  [[nodiscard]] static Elapsed elapsed(double tau_s, double rate) {
    const double a = rate * tau_s;
    const double risen = exponential_rise(a);
    return {tau_s, a, risen, a > 0 ? risen / a : 1};
  }
  /// The same; most ask for the begin and the end, where it is known.
  [[nodiscard]] Elapsed after(double tau_s) const {
    return tau_s == duration_s_ ? whole_ : elapsed(tau_s, rate_);
  }

  [[nodiscard]] FilterState state_after(const Elapsed& e) const {
    return {first_after(e), value_after(e)};
  }
  [[nodiscard]] double first_after(const Elapsed& e) const {
    return state_.first + (input_ - state_.first) * e.rise + slope_ * e.tau_s * (1 - e.mean_decay);
  }
  [[nodiscard]] double value_after(const Elapsed& e) const {
    if (order_ == 1) return first_after(e);
    return state_.output + (input_ - state_.output) * e.rise +
           (state_.first - input_) * e.a * e.decay() +
           slope_ * e.tau_s * (1 + e.decay() - 2 * e.mean_decay);
  }
  /// Of the first stage.
  [[nodiscard]] double first_slope_after(const Elapsed& elapsed) const;
  [[nodiscard]] double slope_after(const Elapsed& elapsed) const;
  /// Where the first stage has its extremum, if it ever has one.
  [[nodiscard]] std::optional<double> first_extremum() const;
  void add_extremum(const Elapsed& from, const Elapsed& to, Extrema& extrema) const;

  FilterState state_;
  double t0_s_;
  double duration_s_;
  double input_;  ///< x0
  double slope_;  ///< s
  double rate_;
  int order_;
  Elapsed whole_;
};

}  // namespace saccade
