#include "simulator/sensor/noise/filtered_piece.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

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

/// 1 - e^-a.
double rise(double a) { return -std::expm1(-a); }

}  // namespace

FilteredPiece::FilteredPiece(const FilterState& state, const LinearPiece& input, double rate,
                             int order)
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

FilteredPiece::Elapsed FilteredPiece::elapsed(double tau_s, double rate) {
  const double a = rate * tau_s;
  const double risen = rise(a);
  return {tau_s, a, risen, a > 0 ? risen / a : 1};
}

double FilteredPiece::first_after(const Elapsed& e) const {
  return state_.first + (input_ - state_.first) * e.rise + slope_ * e.tau_s * (1 - e.mean_decay);
}

double FilteredPiece::value_after(const Elapsed& e) const {
  if (order_ == 1) return first_after(e);
  const double decay = 1 - e.rise;
  return state_.output + (input_ - state_.output) * e.rise + (state_.first - input_) * e.a * decay +
         slope_ * e.tau_s * (1 + decay - 2 * e.mean_decay);
}

FilterState FilteredPiece::state_after(const Elapsed& e) const {
  return {first_after(e), value_after(e)};
}

std::pair<double, double> FilteredPiece::bounds() const {
  const double end = input_ + slope_ * duration_s_;
  const double low = std::min({state_.first, input_, end, state_.output});
  const double high = std::max({state_.first, input_, end, state_.output});
  return {state_.output + (low - state_.output) * whole_.rise,
          state_.output + (high - state_.output) * whole_.rise};
}

double FilteredPiece::first_slope_after(double tau_s) const {
  const double a = rate_ * tau_s;
  return slope_ * rise(a) + rate_ * (input_ - state_.first) * std::exp(-a);
}

double FilteredPiece::slope_after(double tau_s) const {
  if (order_ == 1) return first_slope_after(tau_s);
  const double a = rate_ * tau_s;
  const double decay = std::exp(-a);
  return slope_ * (rise(a) - a * decay) +
         rate_ * decay * ((state_.first - state_.output) - a * (state_.first - input_));
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
    add_extremum(0, *first, extrema);
    add_extremum(*first, duration_s_, extrema);
  } else {
    add_extremum(0, duration_s_, extrema);
  }
  for (double& t : extrema.t_s) t += t0_s_;
  return extrema;
}

/// The extremum of a second-order output strictly between two times after t0, if there is one.
void FilteredPiece::add_extremum(double from_s, double to_s, Extrema& extrema) const {
  double extremum_s = 0;
  if (slope_ == 0) {
    // In closed form, because the slope's sign at the end of a long piece underflows.
    extremum_s = (state_.first - state_.output) / (rate_ * (state_.first - input_));
    if (!(extremum_s > from_s && extremum_s < to_s)) return;
  } else {
    const double slope_from = slope_after(from_s);
    const double slope_to = slope_after(to_s);
    if (!(slope_from < 0 ? slope_to > 0 : slope_from > 0 && slope_to < 0)) return;
    const double sign = slope_from < 0 ? 1 : -1;
    const auto slope = [&](double tau_s) {
      const double at = slope_after(tau_s);
      return ValueAndSlope{sign * at, sign * rate_ * (first_slope_after(tau_s) - at)};
    };
    // The value at an extremum is exact to the square of this.
    constexpr double kTimeFraction = 1e-12;
    extremum_s = close_bracket(slope, from_s, to_s, kTimeFraction * (to_s - from_s));
  }
  extrema.t_s[static_cast<std::size_t>(extrema.count++)] = extremum_s;
}

std::optional<FilterCrossing> FilteredPiece::first_crossing(double lower, double upper,
                                                            double from_s,
                                                            double tolerance_s) const {
  const auto side = [&](double y) { return y >= upper ? 1 : (y <= lower ? -1 : 0); };
  double lo = from_s - t0_s_;
  if (const int polarity = side(value_after(lo)); polarity != 0)
    return FilterCrossing{from_s, polarity};
  const Extrema extrema = this->extrema();
  for (int k = 0; k <= extrema.count; ++k) {
    const double hi =
        k < extrema.count ? extrema.t_s[static_cast<std::size_t>(k)] - t0_s_ : duration_s_;
    if (hi <= lo) continue;
    if (const int polarity = side(value_after(hi)); polarity != 0) {
      const double level = polarity > 0 ? upper : lower;
      const auto excess = [&](double tau_s) {
        return ValueAndSlope{polarity * (value_after(tau_s) - level),
                             polarity * slope_after(tau_s)};
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
