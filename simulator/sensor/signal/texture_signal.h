#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "simulator/sensor/pixel/crossing.h"
#include "simulator/sensor/signal/ray_sample.h"
#include "simulator/sensor/signal/texel_traversal.h"
#include "simulator/sensor/signal/texture_lines.h"

namespace saccade {

/// What a pixel with a single ray sees at an instant of its path over a texture.
struct TrajectorySample {
  double t_s = 0;
  double log_intensity = 0;  ///< ln(eps + radiance)
  double u = 0;              ///< along the path
};

/// The log intensity of a pixel that sees one unlit texture for a while: PixelSignal's most
/// frequent case.
class TextureSignal {
 public:
  using Sample = TrajectorySample;

  /// `path` outlives the signal; `surface`: a sample of the texture, anywhere on it.
  TextureSignal(const TexelTrajectory& path, const SurfaceSample& surface, double log_eps,
                double tolerance_s)
      : path_(path),
        texture_(*surface.texture),
        traversal_(texture_, path_),
        factor_(surface.factor),
        log_eps_(log_eps),
        tolerance_s_(tolerance_s) {}

  [[nodiscard]] double tolerance_s() const { return tolerance_s_; }

  /// A point on the path. Its log intensity is not known yet, unless `is_known` demands it.
  [[nodiscard]] Sample sample_at(double t_s, bool is_known) const {
    const Sample unknown{t_s, kUnknown, path_.fraction(t_s)};
    return is_known ? known(unknown) : unknown;
  }

  [[nodiscard]] Sample at(double t_s, const Sample& /*lo*/, const Sample& /*hi*/) const {
    return evaluate(t_s, path_.fraction(t_s));
  }

  [[nodiscard]] RadianceRange range(const Sample& lo, const Sample& hi) const {
    const CoordinateBounds x(path_.x, lo.u, hi.u);
    const CoordinateBounds y(path_.y, lo.u, hi.u);
    const CellIndex index{x.middle_texel(), y.middle_texel()};
    if (is_within_cell(x.values, index.i) && is_within_cell(y.values, index.j)) {
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
    const HermiteCoordinate x = track(path_.x, lo.u, hi.u);
    const HermiteCoordinate y = track(path_.y, lo.u, hi.u);
    SplitPoint division;
    division.consider_cell(x, y);
    const double fraction =
        division.found() ? division.fraction() : extremum_in_cell(texture_, x, y);
    const double u = lo.u + fraction * (hi.u - lo.u);
    return evaluate(path_.time_s(u), u);
  }

  /// find_exit() that visits only the cells in which the texture may cross a threshold.
  [[nodiscard]] std::optional<Bracket<Sample>> first_exit(const Thresholds& thresholds,
                                                          const Sample& lo,
                                                          const Sample& hi) const {
    const Interval radiances = thresholds.radiances(hi.t_s);
    const Interval texels{radiances.low / factor_, radiances.high / factor_};
    std::optional<Bracket<Sample>> exit;
    const auto search = [&](double u0, double u1) {
      const Sample a = u0 <= lo.u ? known(lo) : evaluate(path_.time_s(u0), u0);
      const Sample b = u1 >= hi.u ? known(hi) : evaluate(path_.time_s(u1), u1);
      // What was passed over as within the band may by the last bit be at its border.
      if (!thresholds.band().contains(thresholds.signal(a)))
        exit = Bracket<Sample>{a, a};
      else if (a.t_s < b.t_s)
        exit = find_exit(*this, thresholds, a, b);
      return !exit;
    };
    const auto visit = [&](const CellSegment& segment, const CellSegment::Bounds& bounds) {
      if (!bounds.is_monotone || !is_inside(texels, bounds.first))
        return search(segment.from(), segment.to());
      if (is_inside(texels, bounds.last)) return true;
      exit = bracket(thresholds, segment, bounds,
                     bounds.last > bounds.first ? texels.high : texels.low);
      return !exit && search(segment.from(), segment.to());
    };
    traversal_.traverse(lo.u, hi.u, texels, visit, search);
    return exit;
  }

  /// use(lines, from, to) with the parts of the signal between two samples along which there are
  /// lines, in order; search(from, to) with those where the path turns.
  using Lines = TextureLines;
  template <class Use, class Search>
  void visit_lines(const Sample& lo, const Sample& hi, const LineLimits& limits, const Use& use,
                   const Search& search) const {
    const auto sample = [&](double u) {
      return u <= lo.u ? lo : u >= hi.u ? hi : evaluate(path_.time_s(u), u);
    };
    traversal_.visit_parts(
        lo.u, hi.u,
        [&](const PathCells& cells, double u0, double u1) {
          TextureLines lines(path_, cells, factor_, log_eps_, limits, u0);
          use(lines, sample(u0), sample(u1));
        },
        [&](double u0, double u1) { search(sample(u0), sample(u1)); });
  }
  /// Where a line has come to, on the way to `to`.
  [[nodiscard]] Sample at_end(const TextureLines& line, const Sample& to) const {
    if (line.u() >= to.u) return to;
    return {path_.time_s(line.u()), log_intensity(line.radiance(), log_eps_), line.u()};
  }
  [[nodiscard]] double time_s(double u) const { return path_.time_s(u); }
  [[nodiscard]] double fraction(double t_s) const { return path_.fraction(t_s); }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] static HermiteCoordinate track(const TrajectoryCoordinate& whole, double u0,
                                               double u1) {
    return {whole.at(u0), whole.slope_at(u0), whole.at(u1), whole.slope_at(u1), u1 - u0};
  }

  [[nodiscard]] static bool is_inside(const Interval& band, double value) {
    return value > band.low && value < band.high;
  }

  /// Two instants around the place in a cell where the texture, rising or falling, reaches `level`;
  /// nothing where the signal says otherwise.
  [[nodiscard]] std::optional<Bracket<Sample>> bracket(const Thresholds& thresholds,
                                                       const CellSegment& segment,
                                                       const CellSegment::Bounds& bounds,
                                                       double level) const {
    constexpr int kSteps = 3;
    double u = segment.from() + (segment.to() - segment.from()) *
                                    ((level - bounds.first) / (bounds.last - bounds.first));
    for (int k = 0; k < kSteps; ++k)
      u = std::clamp(u + (level - segment.value(u)) / segment.slope(u), segment.from(),
                     segment.to());
    if (!std::isfinite(u)) return std::nullopt;  // flat where it should rise
    const double reach = 0.4 * tolerance_s_ / path_.length_s;
    const double before = std::max(u - reach, segment.from());
    const double after = std::min(u + reach, segment.to());
    const Bracket<Sample> found{evaluate(path_.time_s(before), before),
                                evaluate(path_.time_s(after), after)};
    const Band& band = thresholds.band();
    if (!(found.lo.t_s < found.hi.t_s) || !band.contains(thresholds.signal(found.lo)) ||
        band.contains(thresholds.signal(found.hi)))
      return std::nullopt;
    return found;
  }

  [[nodiscard]] Sample known(const Sample& sample) const {
    return std::isnan(sample.log_intensity) ? evaluate(sample.t_s, sample.u) : sample;
  }
  [[nodiscard]] Sample evaluate(double t_s, double u) const {
    const SurfaceSample surface{&texture_, path_.x.at(u), path_.y.at(u), factor_};
    return {t_s, log_intensity(surface.radiance(), log_eps_), u};
  }

  const TexelTrajectory& path_;
  const Texture& texture_;
  TexelTraversal traversal_;
  double factor_;
  double log_eps_;
  double tolerance_s_;
};

}  // namespace saccade
