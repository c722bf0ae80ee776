#pragma once

#include <cstddef>
#include <optional>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/place_finder.h"
#include "estimator/reconstruction/pose_table.h"

namespace saccade {

/// Where pixels look in a reference view whose depth is known. Places are visible where the
/// reference view sees nothing nearer (z-test) and are within it. All pixels are followed from one
/// time to the next, over which the image moves by little, nearly straight; in between places are
/// interpolated.
class SurfacePlaces {
 public:
  /// `reference_inverse_depth`: what the reference view sees. All but the options outlive this.
  /// `longest_px`: the image moves by no more from one time to the next, nor by more than 2 px.
  SurfacePlaces(const PinholeCamera& camera, const DepthScene& scene,
                const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                const PlaceOptions& options, double longest_px);

  void start(const Trajectory& world_from_camera, TimeNs t_ns);
  /// To the next time, at most `last_ns`.
  void advance(const Trajectory& world_from_camera, TimeNs last_ns);

  /// The time that was reached, and the camera there.
  [[nodiscard]] TimeNs end_ns() const { return end_.t_ns; }
  [[nodiscard]] const CameraPose& end_pose() const { return end_.reference_from_camera; }

  /// Of an event between the last two times.
  [[nodiscard]] std::optional<Place> of(const Event& event) const;
  /// What a pixel sees at the time that was reached.
  [[nodiscard]] std::optional<Place> at_end(int x, int y) const {
    const std::size_t i = index_of(x, y);
    const PlaceField& at = end_.places;
    if (!(at.inverse_depth[i] > 0)) return std::nullopt;
    return Place{at.x[i], at.y[i], at.inverse_depth[i]};
  }
  /// How far what the camera sees there was from that at an earlier pose: the furthest of a few
  /// points [px]; infinity where one was behind it.
  [[nodiscard]] double moved_px(const CameraPose& earlier_from_reference) const {
    return finder_.moved_px(end_.reference_from_camera, earlier_from_reference);
  }

 private:
  /// All pixels at one time.
  struct Moment {
    TimeNs t_ns = 0;
    CameraPose reference_from_camera;
    PlaceField places;
  };

  [[nodiscard]] std::size_t index_of(int x, int y) const {
    return static_cast<std::size_t>(y * width_ + x);
  }

  PlaceFinder finder_;
  Rigid3 reference_from_world_;
  int width_;
  float same_surface_;
  double longest_px_;
  Moment begin_, end_;            ///< around the events that are at hand
  TimeNs length_ns_ = 1'000'000;  ///< from one to the other, as it was last
};

}  // namespace saccade
