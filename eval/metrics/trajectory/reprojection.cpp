#include "eval/metrics/trajectory/reprojection.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr std::size_t kMaxInstants = 2000;

struct Sum {
  double squares = 0;
  double max = 0;
  std::size_t count = 0;
};

Sum errors_at(std::span<const Eigen::Vector3f> points, const Rigid3& camera_from_world_estimated,
              const Rigid3& camera_from_world_true, const PinholeCamera& camera) {
  const double diagonal_px = std::hypot(camera.width, camera.height);
  Sum sum;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d in_world = point.cast<double>();
    const Eigen::Vector3d truly = camera_from_world_true * in_world;
    if (!(truly.z() > 0)) continue;
    const Eigen::Vector2d pixel = camera.project(truly);
    if (!camera.contains(pixel)) continue;
    const Eigen::Vector3d estimated = camera_from_world_estimated * in_world;
    double error = diagonal_px;
    if (estimated.z() > 0) error = std::min(error, (camera.project(estimated) - pixel).norm());
    sum.squares += error * error;
    sum.max = std::max(sum.max, error);
    ++sum.count;
  }
  return sum;
}

}  // namespace

ReprojectionSeries reproject(std::span<const Eigen::Vector3f> points_in_world,
                             const ScoredSamples& samples, const PinholeCamera& camera) {
  ReprojectionSeries series;
  const std::size_t stride = (samples.t_s.size() + kMaxInstants - 1) / kMaxInstants;
  Sum all;
  for (std::size_t i = 0; i < samples.t_s.size(); i += stride) {
    const Sum sum = errors_at(points_in_world, samples.estimated[i].inverse(),
                              samples.truth[i].inverse(), camera);
    if (sum.count == 0) continue;
    series.t_s.push_back(samples.t_s[i]);
    series.rms_px.push_back(std::sqrt(sum.squares / static_cast<double>(sum.count)));
    series.max_px.push_back(sum.max);
    all.squares += sum.squares;
    all.count += sum.count;
  }
  if (all.count > 0) series.rms_all_px = std::sqrt(all.squares / static_cast<double>(all.count));
  return series;
}

void set_reprojection(Metrics& metrics, const ReprojectionSeries& series) {
  const std::string key = "trajectory.reprojection_px.";
  std::optional<double> rms, max, rms_max;
  if (!series.t_s.empty()) {
    rms = series.rms_all_px;
    max = *std::max_element(series.max_px.begin(), series.max_px.end());
    rms_max = *std::max_element(series.rms_px.begin(), series.rms_px.end());
  }
  metrics.set(key + "rms", rms);
  metrics.set(key + "max", max);
  metrics.set(key + "rms_max", rms_max);
}

}  // namespace saccade
