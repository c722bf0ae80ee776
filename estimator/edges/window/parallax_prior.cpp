#include "estimator/edges/window/parallax_prior.h"

#include <cmath>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// By how much the picture moves per metre of the camera's axes, RMS over the view.
Eigen::Vector3d motion_px_per_m(const PinholeCamera& camera, double depth_m) {
  // Of coordinates that are spread evenly over a width w the mean square is w^2 / 12.
  const double radius2 =
      (std::pow(camera.width / camera.fx, 2) + std::pow(camera.height / camera.fy, 2)) / 12;
  return camera.fx / depth_m * Eigen::Vector3d(1, 1, std::sqrt(radius2));
}

/// Edges of one outline and nodes next to each other do not vary independently: there are fewer free
/// depths than edges. Of 0, 1/4 and 1 this had the smallest errors on generated worlds.
constexpr double kIndependent = 0.25;

}  // namespace

ParallaxPrior::ParallaxPrior(const PinholeCamera& camera, double typical_depth_m,
                             std::vector<Rigid3> view_from_camera, const DepthFreedom& freedom)
    : freedom_(freedom),
      px_per_m_(motion_px_per_m(camera, typical_depth_m)),
      view_from_camera_(std::move(view_from_camera)),
      information_(view_from_camera_.size()) {
  SACCADE_CHECK(view_from_camera_.size() >= 2);
  parallax2_px2_.reserve(view_from_camera_.size());
  for (const Rigid3& pose : view_from_camera_)
    parallax2_px2_.push_back(pose.translation().cwiseProduct(px_per_m_).squaredNorm());
}

void ParallaxPrior::add_edge(std::span<const NodeSighting> events, double sigma_px) {
  // An edge shows the part of the parallax that is across it: half of its square, over all directions.
  const double each = 1 / (2 * sigma_px * sigma_px);
  double information = 0;
  for (const NodeSighting& event : events) {
    const auto node = static_cast<std::size_t>(event.node);
    SACCADE_CHECK(node + 1 < parallax2_px2_.size());
    information += each * ((1 - event.fraction) * parallax2_px2_[node] +
                           event.fraction * parallax2_px2_[node + 1]);
  }
  const double edge2 = freedom_.edge_sigma * freedom_.edge_sigma;
  const double surface2 = freedom_.surface_sigma * freedom_.surface_sigma;
  const double weight = kIndependent * each *
                        (edge2 / (1 + edge2 * information) +
                         surface2 / (1 + freedom_.edges_per_node * surface2 * information));
  for (const NodeSighting& event : events) {
    const auto node = static_cast<std::size_t>(event.node);
    information_[node] += (1 - event.fraction) * weight;
    information_[node + 1] += event.fraction * weight;
  }
}

ParallaxPrior::OnNode ParallaxPrior::on_node(int node) const {
  // T exp(xi) is at o + R v, v the first half of xi to first order: 0 where v = -R^T o.
  const Rigid3& pose = view_from_camera_[static_cast<std::size_t>(node)];
  OnNode prior;
  prior.mean.head<3>() = -(pose.rotation().conjugate() * pose.translation());
  prior.root.topLeftCorner<3, 3>() =
      std::sqrt(information(node)) * px_per_m_.asDiagonal() * pose.rotation().toRotationMatrix();
  return prior;
}

}  // namespace saccade
