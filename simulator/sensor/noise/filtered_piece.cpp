#include "simulator/sensor/noise/filtered_piece.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

using ValueAndSlope = std::pair<double, double>;

/// The upper end of a bracket of the only root of a function that rises through it, closed to
/// `tolerance`: f(lo) < 0 <= f(hi). Newton's steps, aimed half a tolerance past the root so that
/// the bracket closes from both sides; bisection where they leave the bracket or do not halve it in
/// two.
template <class Function>
double close_bracket(const Function& f, double lo, double hi, double tolerance) {
  double t = 0.5 * (lo + hi);
  double width_before = 2 * (hi - lo);
  while (hi - lo > tolerance) {
    if (!(t > lo && t < hi)) t = 0.5 * (lo + hi);
    if (t <= lo || t >= hi) break;  // no double left between them
    const double width = hi - lo;
    const auto [value, slope] = f(t);
    (value < 0 ? lo : hi) = t;
    const bool is_slow = hi - lo > 0.5 * width_before;
    width_before = width;
    t = is_slow ? 0.5 * (lo + hi) : t - value / slope + (value < 0 ? 0.5 : -0.5) * tolerance;
  }
  return hi;
}

}  // namespace

double FilteredPiece::first_slope_after(const Elapsed& e) const {
  return slope_ * e.rise + rate_ * (input_ - state_.first) * e.decay();
}

double FilteredPiece::slope_after(const Elapsed& e) const {
  if (order_ == 1) return first_slope_after(e);
  return slope_ * (e.rise - e.a * e.decay()) +
         rate_ * e.decay() * ((state_.first - state_.output) - e.a * (state_.first - input_));
}

/// The stage's slope s + e^-a (w (x0 - y1_0) - s) vanishes where e^a = 1 + w (y1_0 - x0) / s.
std::optional<double> FilteredPiece::first_extremum() const {
  const double ratio = rate_ * (state_.first - input_) / slope_;
  if (!(ratio > 0) || std::isinf(ratio)) return std::nullopt;
  return std::log1p(ratio) / rate_;
}

/// e^a times the second stage's slope is s e^a + P - Q a. Its own slope s e^a - Q vanishes where
/// an extremum of the first stage, so on either side of that time the output has at most one.
FilteredPiece::Extrema FilteredPiece::extrema() const {
  Extrema extrema;
  const std::optional<double> first = first_extremum();
  if (order_ == 1) {
    if (first && *first < duration_s_)
      extrema.t_s[static_cast<std::size_t>(extrema.count++)] = *first;
  } else if (first && *first < duration_s_) {
    const Elapsed turn = after(*first);
    add_extremum(kStart, turn, extrema);
    add_extremum(turn, whole_, extrema);
  } else {
    add_extremum(kStart, whole_, extrema);
  }
  for (double& t : extrema.t_s) t += t0_s_;
  return extrema;
}

/// The extremum of a second-order output strictly between two times after t0, if there is one.
void FilteredPiece::add_extremum(const Elapsed& from, const Elapsed& to, Extrema& extrema) const {
  double extremum_s = 0;
  if (slope_ == 0) {
    // In closed form, because the slope's sign at the end of a long piece underflows.
    extremum_s = (state_.first - state_.output) / (rate_ * (state_.first - input_));
    if (!(extremum_s > from.tau_s && extremum_s < to.tau_s)) return;
  } else {
    const double slope_from = slope_after(from);
    const double slope_to = slope_after(to);
    if (!(slope_from < 0 ? slope_to > 0 : slope_from > 0 && slope_to < 0)) return;
    const double sign = slope_from < 0 ? 1 : -1;
    const auto slope = [&](double tau_s) {
      const Elapsed now = after(tau_s);
      const double at = slope_after(now);
      return ValueAndSlope{sign * at, sign * rate_ * (first_slope_after(now) - at)};
    };
    // The value at an extremum is exact to the square of this.
    constexpr double kTimeFraction = 1e-12;
    extremum_s =
        close_bracket(slope, from.tau_s, to.tau_s, kTimeFraction * (to.tau_s - from.tau_s));
  }
  extrema.t_s[static_cast<std::size_t>(extrema.count++)] = extremum_s;
}

std::optional<FilterCrossing> FilteredPiece::first_crossing(double lower, double upper,
                                                            double from_s,
                                                            double tolerance_s) const {
  const auto side = [&](double y) { return y >= upper ? 1 : (y <= lower ? -1 : 0); };
  double lo = from_s - t0_s_;
  if (const int polarity = side(value_after(after(lo))); polarity != 0)
    return FilterCrossing{from_s, polarity};
  const Extrema extrema = this->extrema();
  for (int k = 0; k <= extrema.count; ++k) {
    const double hi =
        k < extrema.count ? extrema.t_s[static_cast<std::size_t>(k)] - t0_s_ : duration_s_;
    if (hi <= lo) continue;
    if (const int polarity = side(value_after(after(hi))); polarity != 0) {
      const double level = polarity > 0 ? upper : lower;
      const auto excess = [&](double tau_s) {
        const Elapsed now = after(tau_s);
        return ValueAndSlope{polarity * (value_after(now) - level), polarity * slope_after(now)};
      };
      return FilterCrossing{t0_s_ + close_bracket(excess, lo, hi, tolerance_s), polarity};
    }
    lo = hi;
  }
  return std::nullopt;
}

/// z = y + m (t - t0) is what the same stages make of an input with slope s + m that stands m / w
/// higher per stage.
FilteredPiece FilteredPiece::drifting(double slope) const {
  FilteredPiece piece = *this;
  const double lift = slope / rate_;
  piece.slope_ += slope;
  piece.input_ += order_ * lift;
  if (order_ == 2) piece.state_.first += lift;
  return piece;
}

}  // namespace saccade
