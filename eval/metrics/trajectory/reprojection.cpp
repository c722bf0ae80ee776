#include "eval/metrics/trajectory/reprojection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/rigid3.h"

namespace saccade {
namespace {

constexpr std::size_t kMaxInstants = 2000;

/// Points whose errors are computed together, as vector code. Each has sums of its own, so that the order
/// of addition does not depend on how wide the processor's vectors are.
constexpr std::size_t kTogether = 8;

/// The map in columns [m], padded with NaN: whatever is compared with it is false, so that no camera sees it.
class PointColumns {
 public:
  explicit PointColumns(std::span<const Eigen::Vector3f> points)
      : size_((points.size() + kTogether - 1) / kTogether * kTogether) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns_[axis].assign(size_, std::numeric_limits<double>::quiet_NaN());
      for (std::size_t i = 0; i < points.size(); ++i)
        columns_[axis][i] = static_cast<double>(points[i](static_cast<Eigen::Index>(axis)));
    }
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const double* axis(std::size_t axis) const { return columns_[axis].data(); }

 private:
  std::size_t size_;
  std::array<std::vector<double>, 3> columns_;
};

/// K [R t] of a pose, which takes a point in the world to (u z, v z, z), z being its depth and (u, v) its pixel.
using Projection = Eigen::Matrix<double, 3, 4>;

Projection projection(const PinholeCamera& camera, const Rigid3& world_from_camera) {
  const Rigid3 camera_from_world = world_from_camera.inverse();
  Projection p;
  p << camera_from_world.rotation_matrix(), camera_from_world.translation();
  return camera.matrix() * p;
}

struct Sum {
  double squares = 0;
  double max_square = 0;
  std::size_t count = 0;
};

Sum errors_at(const PointColumns& points, const Projection& estimate, const Projection& truth,
              const PinholeCamera& camera) {
  const double right = camera.width - 1;
  const double bottom = camera.height - 1;
  const double most = static_cast<double>(camera.width) * camera.width +
                      static_cast<double>(camera.height) * camera.height;
  std::array<double, kTogether> squares{}, greatest{}, seen{};
  for (std::size_t first = 0; first < points.size(); first += kTogether)
    for (std::size_t lane = 0; lane < kTogether; ++lane) {
      const double x = points.axis(0)[first + lane];
      const double y = points.axis(1)[first + lane];
      const double z = points.axis(2)[first + lane];
      const auto row = [&](const Projection& p, Eigen::Index r) {
        return p(r, 0) * x + p(r, 1) * y + p(r, 2) * z + p(r, 3);
      };
      const double true_depth = row(truth, 2);
      const double u = row(truth, 0) / true_depth;
      const double v = row(truth, 1) / true_depth;
      const double depth = row(estimate, 2);
      const double du = row(estimate, 0) / depth - u;
      const double dv = row(estimate, 1) / depth - v;
      const double error = du * du + dv * dv;
      const bool is_seen = (true_depth > 0) & (u >= 0) & (v >= 0) & (u <= right) & (v <= bottom);
      const bool is_before = (depth > 0) & (error < most);
      const double square = is_seen ? (is_before ? error : most) : 0;
      squares[lane] += square;
      greatest[lane] = square > greatest[lane] ? square : greatest[lane];
      seen[lane] += is_seen ? 1 : 0;
    }
  Sum sum;
  for (std::size_t lane = 0; lane < kTogether; ++lane) {
    sum.squares += squares[lane];
    sum.max_square = std::max(sum.max_square, greatest[lane]);
    sum.count += static_cast<std::size_t>(seen[lane]);
  }
  return sum;
}

}  // namespace

ReprojectionSeries reproject(std::span<const Eigen::Vector3f> points_in_world,
                             const ScoredSamples& samples, const PinholeCamera& camera) {
  ReprojectionSeries series;
  const PointColumns points(points_in_world);
  const std::size_t stride = (samples.t_s.size() + kMaxInstants - 1) / kMaxInstants;
  Sum all;
  for (std::size_t i = 0; i < samples.t_s.size(); i += stride) {
    const Sum sum = errors_at(points, projection(camera, samples.estimated[i]),
                              projection(camera, samples.truth[i]), camera);
    if (sum.count == 0) continue;
    series.t_s.push_back(samples.t_s[i]);
    series.rms_px.push_back(std::sqrt(sum.squares / static_cast<double>(sum.count)));
    series.max_px.push_back(std::sqrt(sum.max_square));
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
