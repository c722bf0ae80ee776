#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/observations/reprojector.h"
#include "estimator/run/pose_table.h"

namespace saccade {

/// The reprojections of a sensor's pixels into a reference view whose depth is known, over time. A
/// pixel has one where the depth test finds no occluder, within the view. All pixels are followed
/// from one instant to the next, between which the image moves little and nearly straight; in between
/// reprojections are interpolated.
class SurfaceReprojection {
 public:
  /// `reference_inverse_depth`: of the reference view. All but the options outlive this.
  SurfaceReprojection(const PinholeCamera& camera, const DepthScene& scene,
                      const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                      const ReprojectionOptions& options);

  struct Instant {
    TimeNs t_ns = 0;
    CameraPose reference_from_camera;
    std::shared_ptr<const RenderedSurfaces> surfaces;
    int number = 0;  ///< from the first on

    [[nodiscard]] const CameraPose& pose() const { return reference_from_camera; }
    [[nodiscard]] bool has_surfaces_of(const Instant& other) const {
      return surfaces == other.surfaces;
    }
  };

  /// The instants are found by one thread, while others use those that it found before.
  [[nodiscard]] Instant first(const Trajectory& world_from_camera, TimeNs t_ns);
  /// The one after another, at most `last_ns`.
  [[nodiscard]] Instant next(const Instant& from, const Trajectory& world_from_camera,
                             TimeNs last_ns);

  /// Finds the reprojections of the pixels of some rows, which other threads do not use meanwhile. Called for
  /// each instant in turn; those of the one before are kept, too.
  void follow(const Instant& instant, PixelRows rows);

  /// Of an event between the two instants that were followed last.
  [[nodiscard]] std::optional<Reprojection> of(const Event& event, const Instant& begin,
                                               const Instant& end) const;
  /// Of a pixel between them, where it observes one surface at both.
  [[nodiscard]] std::optional<Reprojection> between(int x, int y, const Instant& begin,
                                                    const Instant& end, float fraction) const {
    const std::size_t i = index_of(x, y);
    const ReprojectionField& a = field_of(begin);
    const ReprojectionField& b = field_of(end);
    const float change = b.inverse_depth[i] - a.inverse_depth[i];
    if (!(a.inverse_depth[i] > 0 && b.inverse_depth[i] > 0 &&
          std::abs(change) <= static_cast<float>(kSameSurfaceRatio) * a.inverse_depth[i]))
      return std::nullopt;
    return Reprojection{a.x[i] + fraction * (b.x[i] - a.x[i]),
                        a.y[i] + fraction * (b.y[i] - a.y[i]),
                        a.inverse_depth[i] + fraction * change};
  }
  /// Of a pixel at the instant that was followed last.
  [[nodiscard]] std::optional<Reprojection> at(int x, int y, const Instant& instant) const {
    const std::size_t i = index_of(x, y);
    const ReprojectionField& field = field_of(instant);
    if (!(field.inverse_depth[i] > 0)) return std::nullopt;
    return Reprojection{field.x[i], field.y[i], field.inverse_depth[i]};
  }
  /// Image motion from an earlier pose to an instant, the maximum over a few points of the surfaces that were rendered
  /// last [px]; infinity where one was behind the camera. For the thread that finds instants.
  [[nodiscard]] double moved_px(const Instant& instant,
                                const CameraPose& earlier_from_reference) const {
    return projector_.moved_px(instant.reference_from_camera, earlier_from_reference);
  }

 private:
  [[nodiscard]] std::size_t index_of(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] const ReprojectionField& field_of(const Instant& instant) const {
    return fields_[static_cast<std::size_t>(instant.number % 2)];
  }

  Reprojector projector_;
  Rigid3 reference_from_world_;
  int width_;
  std::array<ReprojectionField, 2> fields_;  ///< of instants with even and odd numbers
  TimeNs interval_ns_ = 1'000'000;           ///< last interval between them
};

}  // namespace saccade
