#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "simulator/sensor/signal/texel_traversal.h"
#include "simulator/sensor/pixel/crossing.h"
#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {

/// What a pixel with a single ray sees at an instant of its path over a texture.
struct PlaneSample {
  double t_s = 0;
  double log_intensity = 0;  ///< ln(eps + radiance)
  double u = 0;              ///< along the path
};

/// The log intensity of a pixel that sees one unlit texture for a while: PixelSignal's most
/// frequent case.
class PlaneSignal {
 public:
  using Sample = PlaneSample;

  /// `path` outlives the signal; `look`: at the texture, anywhere on it.
  PlaneSignal(const PlanePath& path, const SurfaceLook& look, double log_eps, double tolerance_s)
      : path_(path),
        texture_(*look.texture),
        walk_(texture_, path_),
        factor_(look.factor),
        log_eps_(log_eps),
        tolerance_s_(tolerance_s) {}

  [[nodiscard]] double tolerance_s() const { return tolerance_s_; }

  /// A place on the path. Its log intensity is not known yet, unless `is_known` demands it.
  [[nodiscard]] Sample place(double t_s, bool is_known) const {
    const Sample unknown{t_s, kUnknown, path_.fraction(t_s)};
    return is_known ? known(unknown) : unknown;
  }

  [[nodiscard]] Sample at(double t_s, const Sample& /*lo*/, const Sample& /*hi*/) const {
    return sample(t_s, path_.fraction(t_s));
  }

  [[nodiscard]] RadianceRange range(const Sample& lo, const Sample& hi) const {
    const TrackPart x(path_.x, lo.u, hi.u);
    const TrackPart y(path_.y, lo.u, hi.u);
    const CellIndex index{x.middle_texel(), y.middle_texel()};
    if (is_within(x.values, index.i) && is_within(y.values, index.j)) {
      const Cell cell = cell_of(texture_, index, x.values, y.values);
      const Interval values = cell.values();
      const Interval along_x = product(cell.slopes_x(), x.slopes);
      const Interval along_y = product(cell.slopes_y(), y.slopes);
      const double scale = factor_ / path_.length_s;
      return {factor_ * values.low, factor_ * values.high, scale * (along_x.low + along_y.low),
              scale * (along_x.high + along_y.high)};
    }
    const TexelRange texels =
        texture_.range({x.values.low, x.values.high, y.values.low, y.values.high});
    return {factor_ * texels.low, factor_ * texels.high, -RadianceRange::kUnknown,
            RadianceRange::kUnknown};
  }

  /// At the border of a texel next to the middle, or where the radiance turns within one.
  [[nodiscard]] Sample divide(const Sample& lo, const Sample& hi, int /*depth*/) const {
    const Track x = track(path_.x, lo.u, hi.u);
    const Track y = track(path_.y, lo.u, hi.u);
    Division division;
    division.consider_cell(x, y);
    const double fraction =
        division.found() ? division.fraction() : extremum_in_cell(texture_, x, y);
    const double u = lo.u + fraction * (hi.u - lo.u);
    return sample(path_.time_s(u), u);
  }

  /// find_exit() that looks only into the cells in which the texture may cross a threshold.
  [[nodiscard]] std::optional<Bracket<Sample>> first_exit(const Thresholds& thresholds,
                                                          const Sample& lo,
                                                          const Sample& hi) const {
    const Interval radiances = thresholds.radiances(hi.t_s);
    const Interval texels{radiances.low / factor_, radiances.high / factor_};
    std::optional<Bracket<Sample>> exit;
    const auto look_closer = [&](double u0, double u1) {
      const Sample a = u0 <= lo.u ? known(lo) : sample(path_.time_s(u0), u0);
      const Sample b = u1 >= hi.u ? known(hi) : sample(path_.time_s(u1), u1);
      // What was passed over as within the band may by the last bit be at its border.
      if (!thresholds.band().holds(thresholds.signal(a)))
        exit = Bracket<Sample>{a, a};
      else if (a.t_s < b.t_s)
        exit = find_exit(*this, thresholds, a, b);
      return !exit;
    };
    const auto look = [&](const CellCourse& course, const CellCourse::Shape& shape) {
      if (!shape.is_monotone || !is_inside(texels, shape.first))
        return look_closer(course.from(), course.to());
      if (is_inside(texels, shape.last)) return true;
      exit =
          bracket(thresholds, course, shape, shape.last > shape.first ? texels.high : texels.low);
      return !exit && look_closer(course.from(), course.to());
    };
    walk_.go(lo.u, hi.u, texels, look, look_closer);
    return exit;
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] static Track track(const PlaneTrack& whole, double u0, double u1) {
    return {whole.at(u0), whole.slope_at(u0), whole.at(u1), whole.slope_at(u1), u1 - u0};
  }

  [[nodiscard]] static bool is_inside(const Interval& band, double value) {
    return value > band.low && value < band.high;
  }

  /// Two instants around the place in a cell where the texture, rising or falling, reaches `level`;
  /// nothing where the signal says otherwise.
  [[nodiscard]] std::optional<Bracket<Sample>> bracket(const Thresholds& thresholds,
                                                       const CellCourse& course,
                                                       const CellCourse::Shape& shape,
                                                       double level) const {
    constexpr int kSteps = 3;
    double u = course.from() +
               (course.to() - course.from()) * ((level - shape.first) / (shape.last - shape.first));
    for (int k = 0; k < kSteps; ++k)
      u = std::clamp(u + (level - course.value(u)) / course.slope(u), course.from(), course.to());
    if (!std::isfinite(u)) return std::nullopt;  // flat where it should rise
    const double reach = 0.4 * tolerance_s_ / path_.length_s;
    const double before = std::max(u - reach, course.from());
    const double after = std::min(u + reach, course.to());
    const Bracket<Sample> found{sample(path_.time_s(before), before),
                                sample(path_.time_s(after), after)};
    const Band& band = thresholds.band();
    if (!(found.lo.t_s < found.hi.t_s) || !band.holds(thresholds.signal(found.lo)) ||
        band.holds(thresholds.signal(found.hi)))
      return std::nullopt;
    return found;
  }

  [[nodiscard]] Sample known(const Sample& place) const {
    return std::isnan(place.log_intensity) ? sample(place.t_s, place.u) : place;
  }
  [[nodiscard]] Sample sample(double t_s, double u) const {
    const SurfaceLook look{&texture_, path_.x.at(u), path_.y.at(u), factor_};
    return {t_s, log_intensity(look.radiance(), log_eps_), u};
  }

  const PlanePath& path_;
  const Texture& texture_;
  CellWalk walk_;
  double factor_;
  double log_eps_;
  double tolerance_s_;
};

}  // namespace saccade
