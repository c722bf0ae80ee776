#pragma once

#include <array>
#include <optional>
#include <utility>

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
  FilteredPiece(const FilterState& state, const LinearPiece& input, double rate, int order);

  /// At a time of the piece.
  [[nodiscard]] double value(double t_s) const { return value_after(t_s - t0_s_); }
  [[nodiscard]] FilterState state(double t_s) const {
    return state_after(elapsed(t_s - t0_s_, rate_));
  }
  /// What the next piece is entered with.
  [[nodiscard]] FilterState end_state() const { return state_after(whole_); }

  /// The lowest and the highest value between which the output provably stays. Every stage averages
  /// its input with positive weights, so within the hull [l, h] of the first stage and the input
  ///   y0 + min(0, l - y0)(1 - e^-a) <= y <= y0 + max(0, h - y0)(1 - e^-a)   with a of the end.
  [[nodiscard]] std::pair<double, double> bounds() const;

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
  };
  [[nodiscard]] static Elapsed elapsed(double tau_s, double rate);

  [[nodiscard]] FilterState state_after(const Elapsed& elapsed) const;
  [[nodiscard]] double first_after(const Elapsed& elapsed) const;
  [[nodiscard]] double value_after(const Elapsed& elapsed) const;
  [[nodiscard]] double value_after(double tau_s) const {
    return value_after(elapsed(tau_s, rate_));
  }
  [[nodiscard]] double slope_after(double tau_s) const;
  [[nodiscard]] double first_slope_after(double tau_s) const;
  /// Where the first stage has its extremum, if it ever has one.
  [[nodiscard]] std::optional<double> first_extremum() const;
  void add_extremum(double from_s, double to_s, Extrema& extrema) const;

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
