#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/sensor/pixel/crossing.h"
#include "simulator/sensor/pixel/pixel_noise.h"
#include "simulator/sensor/pixel/pixel_traits.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// A pixel at work: turns intervals of its signal, one after the other, into events.
/// `Emit(t_s, polarity, origin, log_intensity)`.
template <class Signal, class Emit>
class PixelSensor {
 public:
  using Sample = typename Signal::Sample;

  PixelSensor(const Signal& signal, const PixelTraits& traits, double log_eps, PixelState& state,
              Thresholds& thresholds, const Emit& emit)
      : signal_(signal),
        traits_(traits),
        log_eps_(log_eps),
        state_(state),
        thresholds_(thresholds),
        emit_(emit) {}

  /// The ideal pixel, up to its leak. Returns the widest final bracket around a crossing [s].
  double sense(const Sample& lo, const Sample& hi) {
    Sample a = lo;
    while (a.t_s < hi.t_s) {
      const auto exit = first_exit(signal_, thresholds_, a, hi);
      if (!exit) break;
      a = cross(*exit, true).after;
    }
    return widest_s_;
  }

  /// With refractory period, shot noise and hot pixels.
  double sense(const Sample& lo, const Sample& hi, const PixelNoise& noise, NoisyState& noisy);

  /// The same behind the photoreceptor's low pass.
  double sense_filtered(const Sample& lo, const Sample& hi, const PixelNoise& noise,
                        NoisyState& noisy);

 private:
  struct Crossing {
    double t_s;
    Sample after;  ///< within the tolerance
  };

  /// Locates the crossing and fires: once, or for every threshold that the bracket crosses.
  Crossing cross(const Bracket<Sample>& exit, bool repeatedly);
  void fire(double t_s, int polarity, double log_intensity);
  /// The reference becomes the signal.
  void reset(double t_s, double signal);
  /// Draws the candidate that is due; whether the pixel fires at it.
  bool fire_spontaneously(double t_s, double log_intensity, double signal, const PixelNoise& noise,
                          NoisyState& noisy);
  /// What advance() of an interval has come to.
  enum class Reached { kCrossing, kCandidate, kEnd };
  class RawInterval;
  class FilteredInterval;

  /// The one loop of a pixel with imperfections, whatever its signal: at most up to the next
  /// spontaneous candidate, with the refractory period after every event.
  template <class AnyInterval>
  void sense_interval(AnyInterval& interval, const PixelNoise& noise, NoisyState& noisy);
  void sense_piece(const Sample& lo, const Sample& hi, const PixelNoise& noise, NoisyState& noisy) {
    const LinearPiece input{lo.t_s, hi.t_s, lo.log_intensity, hi.log_intensity};
    sense_piece(input, noise.filter.piece(noisy.filter, input), noise, noisy);
  }
  void sense_piece(const LinearPiece& input, const FilteredPiece& piece, const PixelNoise& noise,
                   NoisyState& noisy);
  /// sense_filtered() by halves.
  void divide_filtered(const Sample& lo, const Sample& hi, const PixelNoise& noise,
                       NoisyState& noisy, int depth = 0);
  /// sense_filtered() along the lines of a signal that knows them, up to `hi`.
  template <class Lines>
  void follow_lines(Lines& lines, const Sample& lo, const Sample& hi, const PixelNoise& noise,
                    NoisyState& noisy);
  /// Whether the bounds of the unfiltered signal and the filter's state, between which the output
  /// stays, prove that nothing happens over an interval.
  [[nodiscard]] bool proves_no_event(const RadianceRange& range, double from_s, double to_s,
                                     const NoisyState& noisy) const;
  /// Whether nothing happens over an interval if the unfiltered signal stays within the band.
  [[nodiscard]] bool stays_quiet(double from_s, double to_s, const NoisyState& noisy) const {
    const auto [low, high] = std::minmax(noisy.filter.first, noisy.filter.output);
    return noisy.is_idle(from_s, to_s) && is_within_band(low, from_s, high, to_s);
  }
  /// Whether the bounds of the filtered signal prove that nothing happens over a piece.
  [[nodiscard]] bool proves_no_event(const FilteredPiece& piece, const LinearPiece& input,
                                     const NoisyState& noisy) const;
  /// Drops the candidates that fall into the refractory period.
  void skip_candidates(double until_s, const PixelNoise& noise, NoisyState& noisy) const {
    while (noisy.spontaneous.next_s() < until_s)
      (void)noise.spontaneous.next_candidate(noisy.spontaneous, traits_.x, traits_.y);
  }
  /// Whether values from `low` to `high` stay within the band, however the leak moves it meanwhile.
  [[nodiscard]] bool is_within_band(double low, double from_s, double high, double to_s) const {
    // Rounding may not make a certificate of what is exactly at a threshold.
    constexpr double kGuard = 1e-12;
    const Band& band = state_.reference.band();
    return low + traits_.drift_per_s * from_s > band.lower + kGuard &&
           high + traits_.drift_per_s * to_s < band.upper - kGuard;
  }
  void update_thresholds() {
    thresholds_ =
        Thresholds(state_.reference.band(), traits_.drift_per_s, log_eps_, state_.reference_s);
  }

  const Signal& signal_;
  const PixelTraits& traits_;
  double log_eps_;
  PixelState& state_;
  Thresholds& thresholds_;
  const Emit& emit_;
  double widest_s_ = 0;
};

/// The greatest error of the linear pieces that the low pass is given, where the signal does not
/// jump [log units].
constexpr double kPieceError = 1e-3;
/// The same of lines along a path over a texture, which use up what they are allowed, where the
/// bounds of divided intervals are seldom reached: with this part of it a stream is as near to that
/// of much shorter pieces as with them (of Walls with the noise of a DAVIS240C, 99 % of the events
/// within 54 and 62 us).
constexpr double kLineError = 0.45 * kPieceError;
/// The greatest change within a piece, for which its cutoff is constant [log units].
constexpr double kPieceChange = 0.05;
/// An interval in which nothing happens is passed over up to what the filter remembers at its end,
/// where it is so many times as long as that.
constexpr double kLongMemories = 1.5;

template <class Signal, class Emit>
auto PixelSensor<Signal, Emit>::cross(const Bracket<Sample>& exit, bool repeatedly) -> Crossing {
  const Band band = thresholds_.band();
  const int polarity = thresholds_.signal(exit.hi) >= band.upper ? 1 : -1;
  const double level = polarity > 0 ? band.upper : band.lower;
  const Bracket<Sample> bracket = narrow_bracket(signal_, thresholds_, exit, level);
  widest_s_ = std::max(widest_s_, bracket.width_s());
  const double t_s = bracket.crossing_s(thresholds_, level);
  do {
    fire(t_s, polarity, bracket.hi.log_intensity);
  } while (repeatedly &&
           (polarity > 0 ? thresholds_.signal(bracket.hi) >= state_.reference.band().upper
                         : thresholds_.signal(bracket.hi) <= state_.reference.band().lower));
  update_thresholds();
  return {t_s, bracket.hi};
}

template <class Signal, class Emit>
void PixelSensor<Signal, Emit>::fire(double t_s, int polarity, double log_intensity) {
  const double leaked = traits_.drift_per_s * (t_s - state_.reference_s);
  const bool is_leak = polarity > 0 && leaked > 0.5 * traits_.contrast.on;
  state_.reference.fire(polarity, traits_.contrast);
  state_.reference_s = t_s;
  emit_(t_s, polarity, is_leak ? EventOrigin::kLeak : EventOrigin::kSignal, log_intensity);
}

template <class Signal, class Emit>
void PixelSensor<Signal, Emit>::reset(double t_s, double signal) {
  state_.reference.reset(signal, traits_.contrast);
  state_.reference_s = t_s;
  update_thresholds();
}

template <class Signal, class Emit>
bool PixelSensor<Signal, Emit>::fire_spontaneously(double t_s, double log_intensity, double signal,
                                                   const PixelNoise& noise, NoisyState& noisy) {
  const SpontaneousCandidate candidate =
      noise.spontaneous.next_candidate(noisy.spontaneous, traits_.x, traits_.y);
  if (!noise.spontaneous.accepts(candidate, log_intensity)) return false;
  emit_(t_s, candidate.polarity, candidate.origin, log_intensity);
  reset(t_s, signal);
  return true;
}

template <class Signal, class Emit>
template <class AnyInterval>
void PixelSensor<Signal, Emit>::sense_interval(AnyInterval& interval, const PixelNoise& noise,
                                               NoisyState& noisy) {
  while (interval.t_s() < interval.end_s()) {
    if (noisy.refractory_until_s >= interval.t_s()) {
      if (noisy.refractory_until_s >= interval.end_s()) break;
      interval.skip_to(noisy.refractory_until_s);
      skip_candidates(interval.t_s(), noise, noisy);
      noisy.refractory_until_s = NoisyState::kNotRefractory;
      reset(interval.t_s(), interval.signal());
    }
    const Reached reached = interval.advance(noisy.spontaneous.next_s());
    const bool fires = reached == Reached::kCrossing ||
                       (reached == Reached::kCandidate &&
                        fire_spontaneously(interval.t_s(), interval.log_intensity(),
                                           interval.signal(), noise, noisy));
    if (fires && noise.refractory_s > 0)
      noisy.refractory_until_s = interval.event_s() + noise.refractory_s;
  }
}

/// The signal itself, whose crossings are searched by branch and bound.
template <class Signal, class Emit>
class PixelSensor<Signal, Emit>::RawInterval {
 public:
  /// `repeatedly`: fires for every threshold that a bracket crosses.
  RawInterval(PixelSensor& pixel, const Sample& lo, const Sample& hi, bool repeatedly)
      : pixel_(pixel), now_(lo), hi_(hi), repeatedly_(repeatedly), event_s_(lo.t_s) {}
  [[nodiscard]] double t_s() const { return now_.t_s; }
  [[nodiscard]] double end_s() const { return hi_.t_s; }
  [[nodiscard]] double event_s() const { return event_s_; }
  [[nodiscard]] double signal() const { return pixel_.thresholds_.signal(now_); }
  [[nodiscard]] double log_intensity() const { return now_.log_intensity; }
  void skip_to(double t_s) {
    if (t_s > now_.t_s) now_ = pixel_.signal_.at(t_s, now_, hi_);
  }
  [[nodiscard]] Reached advance(double next_s) {
    const Sample to = next_s <= now_.t_s ? now_
                      : next_s < hi_.t_s ? pixel_.signal_.at(next_s, now_, hi_)
                                         : hi_;
    if (to.t_s > now_.t_s)
      if (const auto exit = first_exit(pixel_.signal_, pixel_.thresholds_, now_, to)) {
        const Crossing crossing = pixel_.cross(*exit, repeatedly_);
        event_s_ = crossing.t_s;
        now_ = crossing.after;
        return Reached::kCrossing;
      }
    now_ = to;
    event_s_ = to.t_s;
    return next_s <= to.t_s ? Reached::kCandidate : Reached::kEnd;
  }

 private:
  PixelSensor& pixel_;
  Sample now_;
  const Sample& hi_;
  bool repeatedly_;
  double event_s_;
};

template <class Signal, class Emit>
double PixelSensor<Signal, Emit>::sense(const Sample& lo, const Sample& hi, const PixelNoise& noise,
                                        NoisyState& noisy) {
  RawInterval interval(*this, lo, hi, noise.refractory_s == 0);
  sense_interval(interval, noise, noisy);
  return widest_s_;
}

template <class Signal, class Emit>
double PixelSensor<Signal, Emit>::sense_filtered(const Sample& lo, const Sample& hi,
                                                 const PixelNoise& noise, NoisyState& noisy) {
  if constexpr (requires { typename Signal::Lines; })
    signal_.visit_lines(
        lo, hi, {kLineError, kPieceChange},
        [&](typename Signal::Lines& lines, const Sample& a, const Sample& b) {
          follow_lines(lines, a, b, noise, noisy);
        },
        [&](const Sample& a, const Sample& b) { divide_filtered(a, b, noise, noisy); });
  else
    divide_filtered(lo, hi, noise, noisy);
  return widest_s_;
}

template <class Signal, class Emit>
template <class Lines>
void PixelSensor<Signal, Emit>::follow_lines(Lines& lines, const Sample& lo, const Sample& hi,
                                             const PixelNoise& noise, NoisyState& noisy) {
  const double least_u = signal_.fraction(lo.t_s + signal_.tolerance_s()) - lo.u;
  // An event may cut short the time for which the signal is known to stay within the band.
  double quiet_until_s = lo.t_s;
  double upper = std::numeric_limits<double>::quiet_NaN();
  for (Sample now = lo; now.t_s < hi.t_s;) {
    if (now.t_s >= quiet_until_s || upper != state_.reference.band().upper) {
      upper = state_.reference.band().upper;
      const auto run = lines.run_within(thresholds_.radiances(hi.t_s), hi.u);
      quiet_until_s = signal_.time_s(run.end);
      const double end_s = std::min(quiet_until_s, noisy.spontaneous.next_s());
      const double memory_s = noise.filter.memory_s(run.least);
      if (end_s - now.t_s > kLongMemories * memory_s && stays_quiet(now.t_s, end_s, noisy)) {
        lines.go_to(signal_.fraction(end_s - memory_s));
        now = signal_.at_end(lines, hi);
        noisy.filter = PhotoreceptorFilter::settled(now.log_intensity);
      }
    }
    const double radiance = lines.radiance();
    lines.advance(hi.u, least_u);
    const Sample next = signal_.at_end(lines, hi);
    const LinearPiece input{now.t_s, next.t_s, now.log_intensity, next.log_intensity};
    // I where ln(eps + I) is half way.
    const double middle_radiance =
        std::max(0.0, std::sqrt((log_eps_ + radiance) * (log_eps_ + lines.radiance())) - log_eps_);
    sense_piece(input, noise.filter.piece(noisy.filter, input, middle_radiance), noise, noisy);
    now = next;
  }
}

template <class Signal, class Emit>
void PixelSensor<Signal, Emit>::divide_filtered(const Sample& lo, const Sample& hi,
                                                const PixelNoise& noise, NoisyState& noisy,
                                                int depth) {
  const double length_s = hi.t_s - lo.t_s;
  if (length_s <= signal_.tolerance_s())  // a step
    return sense_piece(lo, hi, noise, noisy);
  const RadianceRange range = signal_.range(lo, hi);
  if (std::abs(hi.log_intensity - lo.log_intensity) <= kPieceChange &&
      range.log_error(log_eps_, length_s) <= kPieceError)
    return sense_piece(lo, hi, noise, noisy);
  const double memory_s = noise.filter.memory_s(range.low);
  if (length_s > kLongMemories * memory_s && proves_no_event(range, lo.t_s, hi.t_s, noisy)) {
    const Sample remembered = signal_.at(hi.t_s - memory_s, lo, hi);
    noisy.filter = PhotoreceptorFilter::settled(remembered.log_intensity);
    return divide_filtered(remembered, hi, noise, noisy, depth + 1);
  }
  const Sample middle = signal_.divide(lo, hi, depth);
  if (!(middle.t_s > lo.t_s && middle.t_s < hi.t_s))  // no double left between them
    return sense_piece(lo, hi, noise, noisy);
  divide_filtered(lo, middle, noise, noisy, depth + 1);
  divide_filtered(middle, hi, noise, noisy, depth + 1);
}

/// A piece of the photoreceptor's output, whose crossings follow in closed form.
template <class Signal, class Emit>
class PixelSensor<Signal, Emit>::FilteredInterval {
 public:
  FilteredInterval(PixelSensor& pixel, const FilteredPiece& piece, double from_s, double to_s)
      : pixel_(pixel),
        piece_(piece),
        drifting_(piece.drifting(pixel.traits_.drift_per_s)),
        drifted_(pixel.traits_.drift_per_s * from_s),
        t_s_(from_s),
        end_s_(to_s) {}
  [[nodiscard]] double t_s() const { return t_s_; }
  [[nodiscard]] double end_s() const { return end_s_; }
  [[nodiscard]] double event_s() const { return t_s_; }
  [[nodiscard]] double signal() const { return drifting_.value(t_s_) + drifted_; }
  [[nodiscard]] double log_intensity() const { return piece_.value(t_s_); }
  void skip_to(double t_s) { t_s_ = t_s; }
  [[nodiscard]] Reached advance(double next_candidate_s) {
    const double tolerance_s = pixel_.signal_.tolerance_s();
    const double next_s = std::max(next_candidate_s, t_s_);
    const Band& band = pixel_.state_.reference.band();
    const auto crossing =
        drifting_.first_crossing(band.lower - drifted_, band.upper - drifted_, t_s_, tolerance_s);
    if (crossing && crossing->t_s <= next_s) {
      t_s_ = crossing->t_s;
      pixel_.widest_s_ = std::max(pixel_.widest_s_, tolerance_s);
      pixel_.fire(t_s_, crossing->polarity, log_intensity());
      pixel_.update_thresholds();
      return Reached::kCrossing;
    }
    t_s_ = std::min(next_s, end_s_);
    return next_s < end_s_ ? Reached::kCandidate : Reached::kEnd;
  }

 private:
  PixelSensor& pixel_;
  const FilteredPiece& piece_;
  FilteredPiece drifting_;  ///< as a pixel with a leaking reference sees it
  double drifted_;
  double t_s_;
  double end_s_;
};

template <class Signal, class Emit>
void PixelSensor<Signal, Emit>::sense_piece(const LinearPiece& input, const FilteredPiece& piece,
                                            const PixelNoise& noise, NoisyState& noisy) {
  noisy.filter = piece.end_state();
  if (proves_no_event(piece, input, noisy)) return;
  FilteredInterval interval(*this, piece, input.t0_s, input.t1_s);
  sense_interval(interval, noise, noisy);
}

template <class Signal, class Emit>
bool PixelSensor<Signal, Emit>::proves_no_event(const RadianceRange& range, double from_s,
                                                double to_s, const NoisyState& noisy) const {
  if (!noisy.is_idle(from_s, to_s)) return false;
  const auto [state_low, state_high] = std::minmax(noisy.filter.first, noisy.filter.output);
  const double low = std::min(state_low, std::log(log_eps_ + std::max(range.low, 0.0)));
  const double high = std::max(state_high, std::log(log_eps_ + range.high));
  return is_within_band(low, from_s, high, to_s);
}

template <class Signal, class Emit>
bool PixelSensor<Signal, Emit>::proves_no_event(const FilteredPiece& piece,
                                                const LinearPiece& input,
                                                const NoisyState& noisy) const {
  if (noisy.refractory_until_s >= input.t0_s) return noisy.refractory_until_s >= input.t1_s;
  if (!noisy.is_idle(input.t0_s, input.t1_s)) return false;
  const auto [low, high] = piece.bounds();
  return is_within_band(low, input.t0_s, high, input.t1_s);
}

}  // namespace saccade
