#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulator/sensor/visibility/edge_culling.h"
#include "simulator/sensor/visibility/transit.h"
#include "simulator/sensor/visibility/shadow_transits.h"
#include "simulator/sensor/rays/ray_tracer.h"

namespace saccade {

/// What a ray sees at an instant.
struct RayLook {
  double t_s;
  const RayView& view;
};

/// Knows, from their corners, when triangles and their shadows come before the rays of a tile, as
/// long as only so many of them are within its reach.
class Foresight {
 public:
  /// Of the rays within `outline`; what is nearer to an edge than `doubt` of the image plane is in
  /// doubt. All outlive it.
  Foresight(const Scene& scene, RayTracer& tracer, const std::array<Eigen::Vector3d, 4>& outline,
            double doubt, double tolerance_s)
      : scene_(scene),
        tracer_(tracer),
        outline_(outline),
        doubt_(doubt),
        tolerance_s_(tolerance_s),
        outside_(doubt) {}

  /// Takes in what can come into view between two times nearer than `farthest_m`; false, and
  /// nothing is known then, where that is too much.
  [[nodiscard]] bool collect(double farthest_m, double from_s, double to_s);
  /// Nothing is known from now on.
  void forget() { candidates_.clear(); }

  /// Restricts itself to a part of that time: at `depth` 0 of all of it, else of the part that was
  /// last set at the depth before.
  void narrow(double from_s, double to_s, std::size_t depth);
  /// Whether there is anything in reach then.
  [[nodiscard]] bool has_any() const { return !passing_.empty(); }

  /// Whether a ray that sees `triangle` at the beginning and the end sees nothing else in between.
  [[nodiscard]] bool stays_in_sight(const Eigen::Vector3d& direction, TriangleId triangle) const;

  /// When the view of a ray changes from the one triangle to the other, to a tenth of the
  /// tolerance, if it sees them at the beginning and the end and nothing else in between; NaN where
  /// that is not certain.
  [[nodiscard]] double change_s(const Eigen::Vector3d& direction, const Sighting& from,
                                const Sighting& to) const;

  /// The rays that the following is asked about, until the next part of the time.
  void turn_to(std::span<const Eigen::Vector3d> directions);

  /// Adds to `times_s`, in any order, when triangles pass through a ray between two looks that both
  /// see others, or leave it between two that see them.
  void find_passes(const Eigen::Vector3d& direction, const RayLook& lo, const RayLook& hi,
                   std::vector<double>& times_s) const;

  /// Adds to `times_s`, in any order, looks that tell the times apart between which a ray sees a
  /// shadow or a gap of light, on the surfaces that it sees at both ends.
  void find_shadows(const Eigen::Vector3d& direction, const Sighting& from, const Sighting& to,
                    std::vector<double>& times_s);

 private:
  /// nullptr where it is out of reach, or has holes.
  [[nodiscard]] const PassingTriangle* find_opaque(TriangleId triangle) const;
  /// Whether nothing else comes before both triangles in the way of a ray.
  [[nodiscard]] bool are_foremost(const Eigen::Vector3d& direction, const PassingTriangle& a,
                                  const PassingTriangle& b) const;
  /// When a triangle is seen within its edges: early, half way or late; what is behind it there may
  /// come before it.
  void find_sightings(const Eigen::Vector3d& direction, TriangleId triangle, double from_s,
                      double to_s, std::vector<double>& times_s) const;
  /// Of a cut-out between two times at which a ray enters and leaves its edges.
  void find_gaps(const Eigen::Vector3d& direction, TriangleId triangle, double from_s, double to_s,
                 const RayLook& lo, const RayLook& hi, std::vector<double>& times_s) const;
  /// Around each change of light, and in between, for a ray that may see `triangle`.
  void find_shadows_on(const Eigen::Vector3d& direction, TriangleId triangle, double from_s,
                       double to_s, std::vector<double>& times_s);

  const Scene& scene_;
  RayTracer& tracer_;
  const std::array<Eigen::Vector3d, 4>& outline_;
  double doubt_;
  double tolerance_s_;
  std::vector<TriangleId> candidates_;                 ///< that may come into view
  std::vector<PassingTriangle> passing_;               ///< of them, in the part of the time
  OutsideTest outside_;                                ///< of passing_
  std::vector<std::vector<TriangleId>> within_reach_;  ///< the same, at each depth
  std::vector<std::size_t> nearby_;     ///< of them, what the rays that it is turned to can meet
  std::vector<TriangleId> nearby_ids_;  ///< the same
  PassingShadows shadows_;
};

}  // namespace saccade
