#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "simulator/sensor/adaptive/surface_arc.h"
#include "simulator/sensor/pixel/crossing.h"
#include "simulator/sensor/signal/cell_bounds.h"
#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {

/// What a pixel sees at an instant.
struct ArcSample {
  double t_s = 0;
  double radiance = 0;
  double log_intensity = 0;  ///< ln(eps + radiance)
};

/// The log intensity of a pixel that sees one triangle, for PixelSensor: values are taken from the
/// arc, and where they are enough is estimated from their differences rather than proven. That is
/// done with radiances, which are polynomials between the borders of texels; their logarithm is
/// not, next to black.
class ArcSignal {
 public:
  using Sample = ArcSample;

  /// The arc outlives the signal.
  ArcSignal(const SurfaceArc& arc, double log_eps, double tolerance_s)
      : arc_(arc), log_eps_(log_eps), tolerance_s_(tolerance_s) {}

  [[nodiscard]] double tolerance_s() const { return tolerance_s_; }

  [[nodiscard]] Sample at(double t_s) const { return with_log(dark(t_s)); }
  [[nodiscard]] Sample at(double t_s, const Sample& /*lo*/, const Sample& /*hi*/) const {
    return at(t_s);
  }
  /// At a border of texels near the middle, else in the middle: so that the parts of the finest
  /// texture are as short as the tolerance after few divisions.
  [[nodiscard]] Sample divide(const Sample& lo, const Sample& hi, int /*depth*/) const {
    const double middle_s = 0.5 * (lo.t_s + hi.t_s);
    const double first_s = arc_.next_border_s(lo.t_s, hi.t_s);
    if (first_s < middle_s && arc_.next_border_s(first_s, hi.t_s) == hi.t_s) return at(first_s);
    const double border_s = arc_.next_border_s(middle_s, hi.t_s);
    return at(border_s < hi.t_s ? border_s : middle_s);
  }

  /// Of the parabola through both ends and the middle; unknown across the border of a texel.
  [[nodiscard]] RadianceRange range(const Sample& lo, const Sample& hi) const {
    if (arc_.next_border_s(lo.t_s, hi.t_s) < hi.t_s) return {};
    const double half_s = 0.5 * (hi.t_s - lo.t_s);
    const double middle = arc_.radiance_at(lo.t_s + half_s);
    const double bend = std::abs(lo.radiance - 2 * middle + hi.radiance);
    const auto [low, high] = std::minmax({lo.radiance, middle, hi.radiance});
    const double before = (middle - lo.radiance) / half_s;
    const double after = (hi.radiance - middle) / half_s;
    const double more = 0.5 * std::abs(after - before);
    return {low - bend, high + bend, std::min(before, after) - more,
            std::max(before, after) + more};
  }

  /// The first part of (lo, hi] at whose end the signal is outside the band: from border to border
  /// of the texels, halved where the bend may reach the band's ends.
  [[nodiscard]] std::optional<Bracket<Sample>> first_exit(const Thresholds& thresholds,
                                                          const Sample& lo,
                                                          const Sample& hi) const {
    const Search search{thresholds, thresholds.radiances(hi.t_s)};
    const double least_s = kPieceTolerances * tolerance_s_;
    for (Sample from = lo; from.t_s < hi.t_s;) {
      const double to_s = std::max(arc_.next_border_s(from.t_s, hi.t_s), from.t_s + least_s);
      const Sample to = to_s < hi.t_s ? dark(to_s) : hi;
      if (const auto exit = exit_of_piece(search, from, to)) return exit;
      from = to;
    }
    return std::nullopt;
  }

 private:
  /// Pieces need not be shorter, however fine the texture is.
  static constexpr double kPieceTolerances = 0.25;
  /// A piece whose halves are no steeper than three times each other rises or falls throughout.
  static constexpr double kMonotoneBend = 0.5;

  struct Search {
    const Thresholds& thresholds;
    Interval inside;  ///< radiances that are within the band for certain
  };

  /// Without the logarithm.
  [[nodiscard]] Sample dark(double t_s) const { return {t_s, arc_.radiance_at(t_s), 0}; }
  [[nodiscard]] Sample with_log(Sample sample) const {
    sample.log_intensity = saccade::log_intensity(sample.radiance, log_eps_);
    return sample;
  }
  [[nodiscard]] bool is_outside(const Search& search, const Sample& sample) const {
    return !(sample.radiance > search.inside.low && sample.radiance < search.inside.high) &&
           !search.thresholds.band().contains(search.thresholds.signal(with_log(sample)));
  }

  [[nodiscard]] std::optional<Bracket<Sample>> exit_of_piece(const Search& search, const Sample& lo,
                                                             const Sample& hi) const {
    const Sample middle = dark(0.5 * (lo.t_s + hi.t_s));
    // A parabola departs from the lines through these by an eighth of the bend.
    const double change = hi.radiance - lo.radiance;
    const double bend = std::abs(lo.radiance - 2 * middle.radiance + hi.radiance);
    const auto [low, high] = std::minmax({lo.radiance, middle.radiance, hi.radiance});
    if (low - bend > search.inside.low && high + bend < search.inside.high) return std::nullopt;
    if (bend <= kMonotoneBend * std::abs(change) || hi.t_s - lo.t_s <= tolerance_s_) {
      if (is_outside(search, middle)) return Bracket<Sample>{with_log(lo), with_log(middle)};
      if (is_outside(search, hi)) return Bracket<Sample>{with_log(lo), with_log(hi)};
      return std::nullopt;
    }
    if (const auto exit = exit_of_piece(search, lo, middle)) return exit;
    return exit_of_piece(search, middle, hi);
  }

  const SurfaceArc& arc_;
  double log_eps_;
  double tolerance_s_;
};

}  // namespace saccade
