#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace saccade {

constexpr double kNoThreshold = std::numeric_limits<double>::infinity();

/// Contrast thresholds of the ideal pixel [log units], both > 0.
struct Contrast {
  double on = 0.15;
  double off = 0.15;
};

/// Log intensities between which a pixel stays silent.
struct Band {
  double lower = 0;  ///< fires OFF when L falls to it
  double upper = 0;  ///< fires ON when L rises to it

  [[nodiscard]] bool holds(double log_intensity) const {
    return log_intensity < upper && log_intensity > lower;
  }
};

/// The ideal event pixel's memory. The reference is rebuilt from two counters, so it has no drift:
/// a signal that returns to a former level meets exactly the former thresholds.
class EventPixel {
 public:
  EventPixel() = default;
  EventPixel(double initial_log_intensity, const Contrast& contrast)
      : initial_(initial_log_intensity) {
    update(contrast);
  }

  [[nodiscard]] const Band& band() const { return band_; }

  void fire(int polarity, const Contrast& contrast) {
    (polarity > 0 ? ons_ : offs_) += 1;
    update(contrast);
  }

 private:
  void update(const Contrast& contrast) {
    band_.upper = level(ons_ + 1, offs_, contrast);
    band_.lower = level(ons_, offs_ + 1, contrast);
  }

  /// Pairs of ON and OFF cancel before anything is rounded.
  [[nodiscard]] double level(double ons, double offs, const Contrast& contrast) const {
    const double pairs = std::min(ons, offs);
    return initial_ + ((ons - pairs) * contrast.on - (offs - pairs) * contrast.off) +
           pairs * (contrast.on - contrast.off);
  }

  double initial_ = 0;
  Band band_;
  double ons_ = 0;  ///< whole numbers
  double offs_ = 0;
};

/// Two instants around a crossing: the signal is on the inner side of the threshold at `lo`, at or
/// beyond it at `hi`.
template <class Sample>
struct Bracket {
  Sample lo, hi;

  [[nodiscard]] double width_s() const { return hi.t_s - lo.t_s; }

  /// The crossing: the straight line between both ends, which for a smooth signal is far more exact
  /// than the bracket is wide; inside the bracket in any case.
  [[nodiscard]] double crossing_s(double level) const {
    const double fraction = (level - lo.log_intensity) / (hi.log_intensity - lo.log_intensity);
    return lo.t_s + std::clamp(fraction, 0.0, 1.0) * width_s();
  }
};

/// Shrinks a bracket of `level` to at most `tolerance_s`: inverse quadratic interpolation where it
/// is safe, else bisection (Chandrupatla, Advances in Engineering Software 28, 1997), so a jump
/// costs no more than a bisection and a smooth signal four or five evaluations. `evaluate(t, lo,
/// hi)` gives the sample at t, knowing the samples around it.
template <class Sample, class Evaluate>
[[nodiscard]] Bracket<Sample> refine(Bracket<Sample> bracket, double level, double tolerance_s,
                                     const Evaluate& evaluate) {
  const auto residual = [level](const Sample& s) { return s.log_intensity - level; };
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
    const Sample sample = evaluate(t, before.lo, before.hi);
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

/// Slopes |dL/dt| of the signal next to a step: what it may do within, unseen [1/s].
struct Slopes {
  double before = 0;
  double after = 0;
};

/// How carefully a step is searched for an excursion that leaves the band and comes back.
struct ExcursionSearch {
  /// A step is halved while an end lies nearer to a threshold than `reach` times the largest change
  /// of the signal over this step and, at their slopes, its neighbours.
  double reach = 0.75;
  double shortest_s = 1e-6;
};

/// Whether the signal, `a` and `b` at the ends of a step, may have left the pixel's band in
/// between.
[[nodiscard]] inline bool may_exit(const Band& band, double a, double b, double step_s,
                                   const Slopes& slopes, const ExcursionSearch& search) {
  const double low = std::min(a, b);
  const double high = std::max(a, b);
  const double margin = std::min(band.upper - high, low - band.lower);
  const double change = std::max(high - low, std::max(slopes.before, slopes.after) * step_s);
  return !(margin > search.reach * change);
}

/// The first part of (a, b] at whose end the signal is outside the band, if there is one.
template <class Sample, class Evaluate>
[[nodiscard]] std::optional<Bracket<Sample>> find_exit(const Band& band, const Sample& a,
                                                       const Sample& b, const Slopes& slopes,
                                                       const ExcursionSearch& search,
                                                       const Evaluate& evaluate) {
  if (!band.holds(b.log_intensity)) return Bracket<Sample>{a, b};
  const double step_s = b.t_s - a.t_s;
  if (step_s < search.shortest_s ||
      !may_exit(band, a.log_intensity, b.log_intensity, step_s, slopes, search))
    return std::nullopt;
  const Sample middle = evaluate(0.5 * (a.t_s + b.t_s), a, b);
  const double first = 2 * std::abs(middle.log_intensity - a.log_intensity) / step_s;
  const double second = 2 * std::abs(b.log_intensity - middle.log_intensity) / step_s;
  if (auto exit = find_exit(band, a, middle, {slopes.before, second}, search, evaluate))
    return exit;
  return find_exit(band, middle, b, {first, slopes.after}, search, evaluate);
}

/// An exit of [a, crossing.lo], which a later crossing in the other direction may hide: a signal
/// that rises out of the band before an occluding edge throws it below. A smooth crossing comes
/// close to its own threshold in any case, so there only the other one is looked at.
template <class Sample, class Evaluate>
[[nodiscard]] std::optional<Bracket<Sample>> find_earlier_exit(
    const Band& band, const Contrast& contrast, const Sample& a, const Bracket<Sample>& crossing,
    double slope_before, const ExcursionSearch& search, const Evaluate& evaluate) {
  constexpr double kJump = 0.1;  // of a threshold, within the time tolerance
  const double change = crossing.hi.log_intensity - crossing.lo.log_intensity;
  Band open = band;
  if (std::abs(change) < kJump * std::min(contrast.on, contrast.off))
    (change > 0 ? open.upper : open.lower) = std::copysign(kNoThreshold, change);
  return find_exit(open, a, crossing.lo, {slope_before, 0}, search, evaluate);
}

/// All crossings within the step (a, b], one after the other; `emit(t_s, polarity)`. Thresholds
/// that one final bracket crosses together (a jump) share their time. Returns the widest final
/// bracket [s].
template <class Sample, class Evaluate, class Emit>
double walk_step(EventPixel& pixel, const Contrast& contrast, Sample a, const Sample& b,
                 const Slopes& slopes, double tolerance_s, const ExcursionSearch& search,
                 const Evaluate& evaluate, const Emit& emit) {
  double widest_s = 0;
  while (a.t_s < b.t_s) {
    const Band band = pixel.band();
    auto exit = find_exit(band, a, b, slopes, search, evaluate);
    if (!exit) break;
    Bracket<Sample> bracket;
    int polarity = 0;
    double level = 0;
    for (; exit;
         exit = find_earlier_exit(band, contrast, a, bracket, slopes.before, search, evaluate)) {
      polarity = exit->hi.log_intensity >= band.upper ? 1 : -1;
      level = polarity > 0 ? band.upper : band.lower;
      bracket = refine(*exit, level, tolerance_s, evaluate);
    }
    widest_s = std::max(widest_s, bracket.width_s());
    const double t = bracket.crossing_s(level);
    while (polarity > 0 ? bracket.hi.log_intensity >= pixel.band().upper
                        : bracket.hi.log_intensity <= pixel.band().lower) {
      pixel.fire(polarity, contrast);
      emit(t, polarity);
    }
    a = bracket.hi;
  }
  return widest_s;
}

}  // namespace saccade
