#include "eval/gate/gate_metric.h"

#include <cmath>
#include <vector>

#include "eval/sweep/metric_info.h"

namespace saccade {
namespace {

bool higher_is_better(const GateMetric& metric) {
  return metric_info(metric.key).better == MetricInfo::Better::kHigher;
}

}  // namespace

std::span<const GateMetric> gate_metrics() {
  static const std::vector<GateMetric> metrics{
      {"trajectory.dt_rel_percent.mean", 1e-3, {}},
      {"trajectory.dtheta_deg.mean", 1e-3, {}},
      {"trajectory.none.ate_rmse_m", 1e-5, {}},
      {"trajectory.reprojection_px.rms", 1e-3, {}},
      {"trajectory.coverage", 1e-2, 0.005},
      {"trajectory.lost_s", 0.1, {}},
      {"depth.rel_mean", 1e-4, {}},
      {"depth.rel_median", 1e-5, {}},
      {"depth.outlier_5_percent", 1e-3, {}},
      {"depth.completeness", 1e-2, {}},
      {"reconstruction.ssim", 1e-2, {}},
      {"reconstruction.pearson", 1e-2, {}},
      {"reconstruction.rmse_log", 1e-3, {}},
      {"reconstruction.observed", 1e-2, {}},
      {"orientation.roll_pitch_rmse_deg", 1e-3, {}},
      {"orientation.rate_rmse_rad_s", 1e-4, {}},
      {"stabilization.within_1px", 1e-2, {}},
      {"mosaic.ssim", 1e-2, {}},
      {"mosaic.pearson", 1e-2, {}},
      {"mosaic.alignment.residual_deg", 1e-3, {}},
  };
  return metrics;
}

GateMetric gate_metric(const std::string& key) {
  for (const GateMetric& metric : gate_metrics())
    if (metric.key == key) return metric;
  return {key, 1e-6, {}};
}

bool is_judged_by_sign(std::string_view key) { return key.ends_with(".fit.scale"); }

std::optional<double> worsening(const GateMetric& metric, double before, double after) {
  if (before + metric.floor <= 0 || after + metric.floor <= 0) return std::nullopt;
  const double change = std::log((after + metric.floor) / (before + metric.floor));
  return higher_is_better(metric) ? -change : change;
}

double relative_change(const GateMetric& metric, double worse) {
  return std::expm1(higher_is_better(metric) ? -worse : worse);
}

}  // namespace saccade
