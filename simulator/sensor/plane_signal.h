#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "simulator/sensor/cell_walk.h"
#include "simulator/sensor/crossing.h"
#include "simulator/sensor/ray_view.h"
#include "simulator/sensor/texel_path.h"

namespace saccade {

/// What a pixel with a single ray sees at an instant of a textured plane.
struct PlaneSample {
  double t_s = 0;
  double log_intensity = 0;       ///< ln(eps + radiance)
  double x = 0, y = 0;            ///< texel coordinates
  double x_rate = 0, y_rate = 0;  ///< [texel/s]
};

/// The log intensity of a pixel that sees one unlit texture for a while, on the cubic path between
/// the ends of a stretch.
class PlaneSignal {
 public:
  using Sample = PlaneSample;

  /// `look`: at the texture, anywhere on it.
  PlaneSignal(const SurfaceLook& look, double log_eps, double tolerance_s)
      : texture_(*look.texture),
        factor_(look.factor),
        log_eps_(log_eps),
        tolerance_s_(tolerance_s) {}

  [[nodiscard]] double tolerance_s() const { return tolerance_s_; }

  /// An end of the stretch, of which only the place is known yet.
  [[nodiscard]] static Sample place(double t_s, const RayView& view) {
    return {t_s, kUnknown, view.look.x, view.look.y, view.x_rate, view.y_rate};
  }
  /// The same with its log intensity.
  [[nodiscard]] Sample looked_up(Sample sample) const {
    if (std::isnan(sample.log_intensity))
      sample.log_intensity = log_intensity_at(sample.x, sample.y);
    return sample;
  }

  /// Whether the path half way is where the cubic has it, up to a small share of what the image
  /// moves within the tolerance.
  [[nodiscard]] bool is_cubic(const Sample& lo, const RayView& middle, const Sample& hi) const {
    constexpr double kShare = 0.02;
    constexpr double kLeast_texel = 1e-6;
    const Track x = x_track(lo, hi);
    const Track y = y_track(lo, hi);
    const double error =
        std::max(std::abs(x.at(0.5) - middle.look.x), std::abs(y.at(0.5) - middle.look.y));
    const double rate = std::max(std::abs(middle.x_rate), std::abs(middle.y_rate));
    return error <= std::max(kShare * tolerance_s_ * rate, kLeast_texel);
  }

  [[nodiscard]] RadianceRange range(const Sample& lo, const Sample& hi) const {
    const Track x = x_track(lo, hi);
    const Track y = y_track(lo, hi);
    const Interval across = x.values();
    const Interval down = y.values();
    const CellIndex index = middle_cell(x, y);
    if (is_within(across, index.i) && is_within(down, index.j)) {
      const Cell cell = cell_of(texture_, index, across, down);
      const Interval values = cell.values();
      const Interval along_x = product(cell.slopes_x(), x.rates());
      const Interval along_y = product(cell.slopes_y(), y.rates());
      return {factor_ * values.low, factor_ * values.high, factor_ * (along_x.low + along_y.low),
              factor_ * (along_x.high + along_y.high)};
    }
    const TexelRange texels = texture_.range({across.low, across.high, down.low, down.high});
    return {factor_ * texels.low, factor_ * texels.high, -RadianceRange::kUnknown,
            RadianceRange::kUnknown};
  }

  [[nodiscard]] Sample divide(const Sample& lo, const Sample& hi, int /*depth*/) const {
    return at(lo.t_s + dividing_fraction(lo, hi) * (hi.t_s - lo.t_s), lo, hi);
  }

  [[nodiscard]] Sample at(double t_s, const Sample& lo, const Sample& hi) const {
    const Track x = x_track(lo, hi);
    const Track y = y_track(lo, hi);
    const double u = (t_s - lo.t_s) / (hi.t_s - lo.t_s);
    const double x_now = x.at(u);
    const double y_now = y.at(u);
    return {t_s, log_intensity_at(x_now, y_now), x_now, y_now, x.rate_at(u), y.rate_at(u)};
  }

  /// find_exit() that looks only into the cells in which the texture may cross a threshold.
  [[nodiscard]] std::optional<Bracket<Sample>> first_exit(const Thresholds& thresholds,
                                                          const Sample& lo,
                                                          const Sample& hi) const {
    const double length_s = hi.t_s - lo.t_s;
    const Interval radiances = thresholds.radiances(hi.t_s);
    const Interval texels{radiances.low / factor_, radiances.high / factor_};
    const auto sample_at = [&](double u) {
      return u <= 0 ? looked_up(lo) : u >= 1 ? looked_up(hi) : at(lo.t_s + u * length_s, lo, hi);
    };
    std::optional<Bracket<Sample>> exit;
    const auto look = [&](double u0, double u1) {
      exit = find_exit(*this, thresholds, sample_at(u0), sample_at(u1));
      return !exit;
    };
    if (!walk_cells(texture_, x_track(lo, hi), y_track(lo, hi), texels, look))
      exit = find_exit(*this, thresholds, looked_up(lo), looked_up(hi));
    return exit;
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] double log_intensity_at(double x, double y) const {
    return log_intensity(SurfaceLook{&texture_, x, y, factor_}.radiance(), log_eps_);
  }

  [[nodiscard]] static Track x_track(const Sample& lo, const Sample& hi) {
    return {lo.x, lo.x_rate, hi.x, hi.x_rate, hi.t_s - lo.t_s};
  }
  [[nodiscard]] static Track y_track(const Sample& lo, const Sample& hi) {
    return {lo.y, lo.y_rate, hi.y, hi.y_rate, hi.t_s - lo.t_s};
  }

  [[nodiscard]] double dividing_fraction(const Sample& lo, const Sample& hi) const {
    const Track x = x_track(lo, hi);
    const Track y = y_track(lo, hi);
    Division division;
    division.consider_cell(x, y);
    if (division.found()) return division.fraction();
    return extremum_in_cell(texture_, x, y);
  }

  const Texture& texture_;
  double factor_;
  double log_eps_;
  double tolerance_s_;
};

}  // namespace saccade
