#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "simulator/scene/light/patch_lighting.h"
#include "simulator/sensor/rays/ray_tracer.h"
#include "simulator/sensor/visibility/edge_culling.h"
#include "simulator/sensor/visibility/transit.h"

namespace saccade {

/// Finds when shadows come and go where a ray intersects a plane, from its points at both ends of a
/// interval and in the middle.
class ShadowTransits {
 public:
  /// use(begin, end), as fractions of the whole, with each time during which the light is hidden;
  /// in order, and as one where triangles that hide it follow on each other.
  template <class Use>
  void find(const PartlyOccludedLight& light, const std::array<Eigen::Vector3d, 3>& points,
            const Use& use) {
    constexpr double kNeighbours = 1e-6;
    hidden_.clear();
    light.lanes.visit_candidates(points, [&](std::size_t i) {
      std::array<std::array<double, 3>, 4> forms;
      for (std::size_t k = 0; k < forms.size(); ++k)
        for (std::size_t m = 0; m < points.size(); ++m)
          forms[k][m] = light.occluders[i].forms[k].at(points[m]);
      find_intervals(forms, [&](double begin, double end) { hidden_.emplace_back(begin, end); });
      return true;
    });
    std::sort(hidden_.begin(), hidden_.end());
    for (std::size_t k = 0; k < hidden_.size();) {
      auto [begin, end] = hidden_[k];
      for (++k; k < hidden_.size() && hidden_[k].first <= end + kNeighbours; ++k)
        end = std::max(end, hidden_[k].second);
      use(begin, end);
    }
  }

 private:
  std::vector<std::pair<double, double>> hidden_;
};

/// The sample of a ray with its time.
struct StampedRaySample {
  double t_s;
  const RaySample& sample;
};

/// Predicts, from the corners of the candidate triangles, when triangles and their shadows cross
/// the rays of a tile. Exact up to the parabolas of TransitTriangle; the number of candidates is
/// limited.
class VisibilityPredictor {
 public:
  /// Of the rays within `outline`. What is nearer to an edge than `edge_margin` on the image plane
  /// counts as uncertain. All arguments outlive it.
  VisibilityPredictor(const Scene& scene, RayTracer& tracer,
                      const std::array<Eigen::Vector3d, 4>& outline, double edge_margin,
                      double tolerance_s)
      : scene_(scene),
        tracer_(tracer),
        outline_(outline),
        edge_margin_(edge_margin),
        tolerance_s_(tolerance_s) {}

  /// Everything that was collected: up to ten megabytes of a tile.
  struct Memory {
    std::vector<TriangleId> candidates;                        ///< that may come into view
    std::vector<TransitTriangle> transits;                     ///< of them, in the part of the time
    EdgeCulling culling;                                       ///< of transits
    std::vector<std::vector<TriangleId>> candidates_at_depth;  ///< the same, at each depth
    std::vector<std::size_t> nearby;  ///< of them, candidates that the selected rays can intersect
    std::vector<TriangleId> nearby_ids;  ///< the same
    ShadowTransits shadows;
  };
  /// Exchanges it for what another predictor has left; the next call is collect() or clear().
  void swap(Memory& memory) { std::swap(memory_, memory); }

  /// Collects the triangles that can become visible between two times nearer than `farthest_m`;
  /// false, and no candidates, where there are too many.
  [[nodiscard]] bool collect(double farthest_m, double from_s, double to_s);
  /// Drops all candidates.
  void clear() { memory_.candidates.clear(); }

  /// Restricts the candidates to those of a part of that time: at `depth` 0 of all of it, else of
  /// the part that was last set at the depth before.
  void restrict_to(double from_s, double to_s, std::size_t depth);
  /// Whether any triangle can be visible in that part.
  [[nodiscard]] bool has_candidates() const { return !memory_.transits.empty(); }

  /// Whether a ray that sees `triangle` at the beginning and the end sees nothing else in between.
  [[nodiscard]] bool stays_visible(const Eigen::Vector3d& direction, TriangleId triangle) const;

  /// When the view of a ray changes from the one triangle to the other, to a tenth of the
  /// tolerance, if it sees them at the beginning and the end and nothing else in between; NaN where
  /// that is not certain.
  [[nodiscard]] double change_s(const Eigen::Vector3d& direction, const VisibleTriangle& from,
                                const VisibleTriangle& to) const;

  /// The rays that the following is asked about, until the next part of the time.
  void select_rays(std::span<const Eigen::Vector3d> directions);

  /// Adds to `times_s`, in any order, when triangles pass through a ray between two samples that
  /// both see others, or leave it between two that see them.
  void find_transits(const Eigen::Vector3d& direction, const StampedRaySample& lo,
                     const StampedRaySample& hi, std::vector<double>& times_s) const;

  /// Adds to `times_s`, in any order, samples that tell the times apart between which a ray sees a
  /// shadow or a gap of light, on the surfaces that it sees at both ends.
  void find_shadows(const Eigen::Vector3d& direction, const VisibleTriangle& from,
                    const VisibleTriangle& to, std::vector<double>& times_s);

 private:
  /// nullptr where it is out of reach, or has holes.
  [[nodiscard]] const TransitTriangle* find_opaque(TriangleId triangle) const;
  /// Whether nothing else comes before both triangles along a ray.
  [[nodiscard]] bool are_in_front(const Eigen::Vector3d& direction, const TransitTriangle& a,
                                  const TransitTriangle& b) const;
  /// When a triangle is seen within its edges: early, in the middle or late; what is behind it
  /// there may come before it.
  void find_visible_times(const Eigen::Vector3d& direction, TriangleId triangle, double from_s,
                          double to_s, std::vector<double>& times_s) const;
  /// Of a cut-out between two times at which a ray enters and leaves its edges.
  void find_gaps(const Eigen::Vector3d& direction, TriangleId triangle, double from_s, double to_s,
                 const StampedRaySample& lo, const StampedRaySample& hi,
                 std::vector<double>& times_s) const;
  /// Around each change of light, and in between, for a ray that may see `triangle`.
  void find_shadows_on(const Eigen::Vector3d& direction, TriangleId triangle, double from_s,
                       double to_s, std::vector<double>& times_s);

  const Scene& scene_;
  RayTracer& tracer_;
  const std::array<Eigen::Vector3d, 4>& outline_;
  double edge_margin_;
  double tolerance_s_;
  Memory memory_;
};

}  // namespace saccade
