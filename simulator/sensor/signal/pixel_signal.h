#pragma once

#include <array>
#include <span>

#include "simulator/sensor/rays/ray_tracer.h"

namespace saccade {

/// What a pixel sees at one instant through its kRays rays.
template <std::size_t kRays>
struct PixelSample {
  double t_s = 0;
  double log_intensity = 0;  ///< ln(eps + mean radiance)
  std::array<RaySample, kRays> rays;

  [[nodiscard]] double radiance() const {
    double sum = 0;
    for (const RaySample& ray : rays) sum += ray.surface.radiance();
    return sum / static_cast<double>(kRays);
  }
};

/// The log intensity of one pixel as a function of time, as find_exit() and narrow_bracket() want
/// it.
template <std::size_t kRays>
class PixelSignal {
 public:
  using Sample = PixelSample<kRays>;

  PixelSignal(RayTracer& tracer, std::span<const Eigen::Vector3d, kRays> directions, double log_eps,
              double tolerance_s)
      : tracer_(tracer), directions_(directions), log_eps_(log_eps), tolerance_s_(tolerance_s) {}

  [[nodiscard]] double tolerance_s() const { return tolerance_s_; }

  [[nodiscard]] RadianceRange range(const Sample& lo, const Sample& hi) const;
  [[nodiscard]] Sample divide(const Sample& lo, const Sample& hi, int depth) const;
  /// With rays, whatever is seen before and after.
  [[nodiscard]] Sample trace(double t_s) const;
  [[nodiscard]] Sample at(double t_s, const Sample& lo, const Sample& hi) const;
  /// at(), whatever lights light both ends.
  [[nodiscard]] Sample resample(double t_s, const Sample& lo, const Sample& hi) const;

  void set_log_intensity(Sample& sample) const {
    sample.log_intensity = saccade::log_intensity(sample.radiance(), log_eps_);
  }

 private:
  /// The first ray whose visible triangle changes, or kRays.
  [[nodiscard]] std::size_t changing_ray(const Sample& lo, const Sample& hi) const;
  /// Of a ray that sees one triangle at the start and another at the end.
  [[nodiscard]] RadianceRange range_across_change(std::size_t ray, const Sample& lo,
                                                  const Sample& hi) const;
  [[nodiscard]] Sample divide_at_change(std::size_t ray, const Sample& lo, const Sample& hi) const;
  /// A ray that sees one triangle at both ends.
  [[nodiscard]] RaySample between(std::size_t ray, const Sample& lo, const Sample& hi,
                                  double t_s) const;

  RayTracer& tracer_;
  std::span<const Eigen::Vector3d, kRays> directions_;
  double log_eps_;
  double tolerance_s_;
};

}  // namespace saccade
