#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/config/fields.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/observations/level_changes.h"
#include "estimator/reconstruction/observations/panorama_reprojection.h"
#include "estimator/reconstruction/observations/surface_reprojection.h"

namespace saccade {

/// Model of one kind of observation.
struct ObservationKind {
  float sigma;     ///< standard deviation [log units]
  float slack;     ///< 0 at an event; of a no-event constraint the log intensity is within +- this
  float expected;  ///< where between -slack and slack it is expected
  float weight = 0;  ///< 1 / sigma^2
};

/// An observation of the reference view by a sensor pixel at one of its reprojections: the log
/// intensity there is `log_intensity` above an offset that is constant along the pixel's event run.
/// Kept small, since there are several per event.
struct IntensityObservation {
  float x, y;           ///< [px of the reference view], within it; see ReferenceGrid::at()
  float log_intensity;  ///< [log units]
  std::uint32_t run_and_kind;

  static constexpr std::uint32_t kKindBits = 3;
  static constexpr std::uint32_t tag(std::uint32_t run, std::uint32_t kind) {
    return run << kKindBits | kind;
  }
  /// Counts from 0.
  [[nodiscard]] std::uint32_t run() const { return run_and_kind >> kKindBits; }
  /// Index into ObservationSource::kinds().
  [[nodiscard]] std::uint32_t kind() const { return run_and_kind & ((1U << kKindBits) - 1); }
};

/// The defaults are those of the thesis's method.
struct ObservationOptions {
  double event_sigma = 0.1;
  int run_events = 1000000;
  bool no_event_constraints = true;
  double no_event_spacing_px = 2;
  /// Every n-th pixel is constrained at a time, a different one each time.
  int no_event_stride = 1;
  /// Where a part of the sensor has more events per pixel, no-event constraints are thinned in
  /// proportion.
  double dense_events_per_px = 1e9;
  /// After its last event a pixel's log intensity goes on beyond it: expected by this fraction of a
  /// threshold, since what passes a pixel most often are edges.
  double expected_fraction = 0.5;
  /// A pixel's first event lies a threshold above or below what it saw at the start, with this
  /// standard deviation in thresholds: how far it had come since an event before is not known. 0: the
  /// first event says nothing.
  double first_event_sigma = 0;
  /// For so long a pixel is blind after an event; nullopt: to be found (find_blind_time_us()), none until then.
  std::optional<double> blind_time_us = 0;
  bool remove_bias = false;  ///< of the changes over a window (change_bias.h)
  ReprojectionOptions reprojection{.redraw_motion_px = 4};
};

/// `has_surfaces`: the observations are of a view with depth, not of a panorama.
void describe(config::Fields& fields, ObservationOptions& options, bool has_surfaces);

/// Turns events into observations of the reference view. At the instant of an event the log intensity
/// is exact but for the pixel's offset: the sum of all p C of the pixel so far (2.8), and of what it missed
/// while it was blind (level_changes.h).
class ObservationSource {
 public:
  virtual ~ObservationSource() = default;

  [[nodiscard]] virtual std::span<const ObservationKind> kinds() const = 0;

  /// Thins no-event constraints where many of `events` lie (dense_events_per_px), weighs what pixels miss
  /// while they are blind and finds the bias of their changes, which changes kinds(). Before observe().
  virtual void plan(std::span<const Event> events) = 0;

  /// Appends the observations of `events` (in order of time, and not before those of an earlier
  /// call).
  virtual void observe(std::span<const Event> events, const Trajectory& world_from_camera,
                       std::vector<IntensityObservation>& observations) = 0;

  /// The observations of all events, passed to `use` part by part with the fraction of the events
  /// up to the end of the part. Returns the seconds it took without `use`.
  double observe_all(
      std::span<const Event> events, const Trajectory& world_from_camera,
      const std::function<void(std::span<const IntensityObservation>, double fraction)>& use);
};

/// `Path`, SurfaceReprojection or PanoramaReprojection, gives the reprojections of the pixels over
/// time.
template <class Path>
class ReprojectedObservations : public ObservationSource {
 public:
  ReprojectedObservations(Path path, const PinholeCamera& camera,
                          const ContrastThresholds& thresholds, const ObservationOptions& options);

  [[nodiscard]] std::span<const ObservationKind> kinds() const override { return kinds_; }
  void plan(std::span<const Event> events) override;
  void observe(std::span<const Event> events, const Trajectory& world_from_camera,
               std::vector<IntensityObservation>& observations) override;

 private:
  /// Indices of kinds_.
  enum Kind : std::uint32_t {
    kEvent,
    kStart,
    kJumpOn,
    kJumpOff,
    kNoEvent,
    kNoEventAfterOn,
    kNoEventAfterOff,
    kKinds
  };

  static constexpr float kNowhere = -1;

  struct Pixel {
    float log_intensity = 0;  ///< sum of the changes up to its last event
    float last_change = 0;    ///< from the event before that
    LevelChanges::Pixel level;
    float inverse_depth = 0;               ///< of the last reprojection; 0: none so far
    float x = 0, y = 0;                    ///< reprojection at its last event
    float observed_x = 0, observed_y = 0;  ///< reprojection at its last observation
    TimeNs t_ns = 0;                       ///< of the last event
    std::uint32_t run = 0;
    int events = 0;                                ///< of its run
    int last_polarity = 0;                         ///< of the last event, 0: none so far
    float start_x = kNowhere, start_y = kNowhere;  ///< reprojection before all events
  };

  void note_starts();
  void add_event(const Event& event, const Reprojection& reprojection,
                 std::vector<IntensityObservation>& observations);
  void add_no_event_constraints(std::vector<IntensityObservation>& observations);
  void add_no_event_constraint(int x, int y, std::vector<IntensityObservation>& observations);

  Path path_;
  float contrast_on_, contrast_off_;
  float expected_;  ///< beyond the last event of a pixel [log units]
  LevelChanges changes_;
  ObservationOptions options_;
  std::array<ObservationKind, kKinds> kinds_;
  Image<Pixel> pixels_;
  Image<int> strides_;                     ///< of no-event constraints, by tile of the sensor
  CameraPose constrained_from_reference_;  ///< the camera when constraints were added last
  int constrained_ = 0;                    ///< number of times they were
  std::uint32_t runs_ = 0;
};

/// Observations of a view whose depth is known.
class SurfaceObservations : public ReprojectedObservations<SurfaceReprojection> {
 public:
  /// `reference_inverse_depth`: of the reference view. All but the options outlive the source.
  SurfaceObservations(const PinholeCamera& camera, const DepthScene& scene,
                      const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                      const ContrastThresholds& thresholds, const ObservationOptions& options)
      : ReprojectedObservations(
            SurfaceReprojection(camera, scene, world_from_reference, reference_inverse_depth,
                                options.reprojection, options.no_event_spacing_px),
            camera, thresholds, options) {}
};

/// Observations of a panorama, whose world is the reference view.
class PanoramaObservations : public ReprojectedObservations<PanoramaReprojection> {
 public:
  PanoramaObservations(const PinholeCamera& camera, const Panorama& panorama,
                       const ContrastThresholds& thresholds, const ObservationOptions& options)
      : ReprojectedObservations(PanoramaReprojection(camera, panorama), camera, thresholds,
                                options) {}
};

}  // namespace saccade
