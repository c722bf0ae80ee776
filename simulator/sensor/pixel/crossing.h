#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "simulator/sensor/pixel/event_pixel.h"
#include "simulator/sensor/signal/cell_bounds.h"
#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {

/// What a pixel fires at, between two events: a band of the signal S(t) = L(t) + drift * t, where L
/// is the log intensity ln(eps + I). For the certificates the band is also known in terms of the
/// radiance I, with which no logarithm is needed.
class Thresholds {
 public:
  Thresholds() = default;
  /// `drift_per_s` >= 0 [1/s]; from `since_s` on.
  Thresholds(const Band& band, double drift_per_s, double log_eps, double since_s = 0)
      : band_(band), drift_(drift_per_s), log_eps_(log_eps), since_s_(since_s) {
    // Rounding may not make a certificate of what is exactly at a threshold.
    constexpr double kGuard = 1e-12;
    lower_ = std::exp(band.lower - drift_ * since_s_) * (1 + kGuard);
    upper_ = std::exp(band.upper - drift_ * since_s_) * (1 - kGuard);
  }

  [[nodiscard]] const Band& band() const { return band_; }

  template <class Sample>
  [[nodiscard]] double signal(const Sample& sample) const {
    return sample.log_intensity + drift_ * sample.t_s;
  }

  /// The radiances, between both bounds, that are inside the band at any time up to `end_s`, with
  /// exp(-x) >= 1 - x for the drift.
  [[nodiscard]] Interval radiances(double end_s) const {
    const double drifted = drift_ == 0 ? 1 : 1 - drift_ * (end_s - since_s_);
    return {lower_ - log_eps_, upper_ * drifted - log_eps_};
  }

  /// Whether no radiance of `range` is outside the band at any time up to `end_s`.
  [[nodiscard]] bool certify(const RadianceRange& range, double end_s) const {
    const Interval inside = radiances(end_s);
    return range.low > inside.low && range.high < inside.high;
  }

  /// Whether the signal rises or falls throughout.
  [[nodiscard]] bool is_monotone(const RadianceRange& range) const {
    return range.is_monotone() && (drift_ == 0 || range.rate_low >= 0 ||
                                   range.rate_high < -drift_ * (log_eps_ + range.high));
  }

 private:
  Band band_;
  double drift_ = 0;
  double log_eps_ = 0;
  double since_s_ = 0;
  double lower_ = 0, upper_ = 0;  ///< eps + I, at since_s_
};

/// Two instants around a crossing: the signal is on the inner side of the threshold at `lo`, at or
/// beyond it at `hi`; or the same instant twice, at which it has just reached it.
template <class Sample>
struct Bracket {
  Sample lo, hi;

  [[nodiscard]] double width_s() const { return hi.t_s - lo.t_s; }

  /// The crossing: the straight line between both ends, which for a smooth signal is far more exact
  /// than the bracket is wide; inside the bracket in any case.
  [[nodiscard]] double crossing_s(const Thresholds& thresholds, double level) const {
    if (width_s() == 0) return lo.t_s;
    const double from = thresholds.signal(lo);
    const double fraction = (level - from) / (thresholds.signal(hi) - from);
    return lo.t_s + std::clamp(fraction, 0.0, 1.0) * width_s();
  }
};

/// Shrinks a bracket of `level` to at most `tolerance_s`: inverse quadratic interpolation where it
/// is safe, else bisection (Chandrupatla, Advances in Engineering Software 28, 1997), so a jump
/// costs no more than a bisection and a smooth signal four or five evaluations.
template <class Signal, class Sample>
[[nodiscard]] Bracket<Sample> narrow_bracket(const Signal& signal, const Thresholds& thresholds,
                                             Bracket<Sample> bracket, double level) {
  const auto residual = [&](const Sample& s) { return thresholds.signal(s) - level; };
  const double tolerance_s = signal.tolerance_s();
  const bool rising = residual(bracket.hi) >= 0 && residual(bracket.lo) < 0;
  const auto beyond = [&](double r) { return rising ? r >= 0 : r <= 0; };
  const double f_lo = residual(bracket.lo);
  const double f_hi = residual(bracket.hi);
  // A step at the limit must close the bracket from the far side, hence a bit less than half.
  const double least_step_s = 0.45 * tolerance_s;
  double fraction = f_lo / (f_lo - f_hi);
  while (bracket.width_s() > tolerance_s) {
    const double limit = std::min(0.5, least_step_s / bracket.width_s());
    const Bracket<Sample> before = bracket;
    const double t = before.lo.t_s + std::clamp(fraction, limit, 1 - limit) * before.width_s();
    if (t <= before.lo.t_s || t >= before.hi.t_s) break;  // no double left between them
    const Sample sample = signal.at(t, before.lo, before.hi);
    const bool is_beyond = beyond(residual(sample));
    (is_beyond ? bracket.hi : bracket.lo) = sample;
    // Newest end a, other end b, and c, which a has replaced.
    const Sample& a = sample;
    const Sample& b = is_beyond ? bracket.lo : bracket.hi;
    const Sample& c = is_beyond ? before.hi : before.lo;
    const double fa = residual(a);
    const double fb = residual(b);
    const double fc = residual(c);
    const double xi = (a.t_s - b.t_s) / (c.t_s - b.t_s);
    const double phi = (fa - fb) / (fc - fb);
    double from_a = 0.5;
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)
      from_a = fa / (fb - fa) * fc / (fb - fc) +
               (c.t_s - a.t_s) / (b.t_s - a.t_s) * fa / (fc - fa) * fb / (fc - fb);
    fraction = is_beyond ? 1 - from_a : from_a;
  }
  return bracket;
}

/// The first part of (lo, hi] at whose end the signal is outside the band, if there is one: branch
/// and bound. An interval is done when the bounds of its radiance prove that it stays inside, when
/// it is monotone, so that its ends tell, or when it is shorter than the tolerance; else it is
/// divided where the signal says. Needs of `signal`: range(lo, hi), divide(lo, hi, depth), at(t,
/// lo, hi), tolerance_s().
template <class Signal, class Sample>
[[nodiscard]] std::optional<Bracket<Sample>> find_exit(const Signal& signal,
                                                       const Thresholds& thresholds,
                                                       const Sample& lo, const Sample& hi,
                                                       int depth = 0) {
  const RadianceRange range = signal.range(lo, hi);
  if (thresholds.certify(range, hi.t_s)) return std::nullopt;
  if (thresholds.is_monotone(range) || hi.t_s - lo.t_s <= signal.tolerance_s()) {
    if (thresholds.band().contains(thresholds.signal(hi))) return std::nullopt;
    return Bracket<Sample>{lo, hi};
  }
  const Sample middle = signal.divide(lo, hi, depth);
  if (!(middle.t_s > lo.t_s && middle.t_s < hi.t_s)) {  // no double left between them
    if (thresholds.band().contains(thresholds.signal(hi))) return std::nullopt;
    return Bracket<Sample>{lo, hi};
  }
  if (auto exit = find_exit(signal, thresholds, lo, middle, depth + 1)) return exit;
  return find_exit(signal, thresholds, middle, hi, depth + 1);
}

/// find_exit(), for signals without a quicker way of their own.
template <class Signal, class Sample>
[[nodiscard]] std::optional<Bracket<Sample>> first_exit(const Signal& signal,
                                                        const Thresholds& thresholds,
                                                        const Sample& lo, const Sample& hi) {
  if constexpr (requires { signal.first_exit(thresholds, lo, hi); })
    return signal.first_exit(thresholds, lo, hi);
  else
    return find_exit(signal, thresholds, lo, hi);
}

}  // namespace saccade
