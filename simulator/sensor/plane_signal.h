#pragma once

#include <cmath>

#include "simulator/sensor/ray_tracer.h"
#include "simulator/sensor/texel_path.h"

namespace saccade {

/// What a pixel with a single ray sees at an instant of a textured plane.
struct PlaneSample {
  double t_s = 0;
  double log_intensity = 0;       ///< ln(eps + radiance)
  double x = 0, y = 0;            ///< texel coordinates
  double x_rate = 0, y_rate = 0;  ///< [texel/s]
};

/// The log intensity of a pixel that sees one unlit texture for a while: PixelSignal's most
/// frequent case, with nothing to carry about but the place on the texture.
class PlaneSignal {
 public:
  using Sample = PlaneSample;

  PlaneSignal(RayTracer& tracer, const Eigen::Vector3d& direction, TriangleId triangle,
              const TexelMap& map, double log_eps, double tolerance_s)
      : tracer_(tracer),
        direction_(direction),
        triangle_(triangle),
        texture_(*map.texture),
        factor_(map.factor),
        log_eps_(log_eps),
        tolerance_s_(tolerance_s) {}

  [[nodiscard]] double tolerance_s() const { return tolerance_s_; }

  [[nodiscard]] Sample sample(double t_s, double x, double y, double x_rate, double y_rate) const {
    const SurfaceLook look{&texture_, x, y, factor_};
    return {t_s, saccade::log_intensity(look.radiance(), log_eps_), x, y, x_rate, y_rate};
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
    if (x.stray() + y.stray() < kStraight_texel) {
      const double u = (t_s - lo.t_s) / (hi.t_s - lo.t_s);
      return sample(t_s, x.at(u), y.at(u), x.rate_at(u), y.rate_at(u));
    }
    const RayView view = tracer_.unlit_view(direction_, triangle_, t_s);
    return sample(t_s, view.look.x, view.look.y, view.x_rate, view.y_rate);
  }

 private:
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

  RayTracer& tracer_;
  const Eigen::Vector3d& direction_;
  TriangleId triangle_;
  const Texture& texture_;
  double factor_;
  double log_eps_;
  double tolerance_s_;
};

}  // namespace saccade
