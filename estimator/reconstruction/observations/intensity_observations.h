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

/// Receives the observations of a band of the sensor's rows: a batch of them, in order of time. Their runs are
/// those of the band, which count from 0. Several threads call it, each for bands of its own.
using ObservationSink =
    std::function<void(std::size_t band, std::span<const IntensityObservation>)>;

/// Turns events into observations of the reference view. At the instant of an event the log intensity
/// is exact but for the pixel's offset: the sum of all p C of the pixel so far (2.8), and of what it missed
/// while it was blind (level_changes.h).
class ObservationSource {
 public:
  virtual ~ObservationSource() = default;

  [[nodiscard]] virtual std::span<const ObservationKind> kinds() const = 0;

  /// The observations of all events of a window, which are in order of time, batch by batch. The sensor is divided into
  /// `bands` > 0 of rows with about as much work each; the bands of a batch are observed in parallel. After each batch calls
  /// `done` with the fraction of the events up to its end. Returns the seconds it took with `use`, without
  /// `done`. Before the first observation it thins no-event constraints where many events lie
  /// (dense_events_per_px), weighs what pixels miss while they are blind, and finds the bias of their changes, which
  /// changes kinds(). Once for each source.
  virtual double observe(std::span<const Event> events, const Trajectory& world_from_camera,
                         std::size_t bands, const ObservationSink& use,
                         const std::function<void(double fraction)>& done) = 0;
};

/// `Path`, SurfaceReprojection or PanoramaReprojection, gives the reprojections of the pixels over
/// time. Its instants are found first, for the whole sensor; then each band of rows goes through them by itself.
template <class Path>
class ReprojectedObservations : public ObservationSource {
 public:
  ReprojectedObservations(Path path, const PinholeCamera& camera,
                          const ContrastThresholds& thresholds, const ObservationOptions& options);

  [[nodiscard]] std::span<const ObservationKind> kinds() const override { return kinds_; }
  double observe(std::span<const Event> events, const Trajectory& world_from_camera,
                 std::size_t bands, const ObservationSink& use,
                 const std::function<void(double fraction)>& done) override;

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

  /// One line of the cache: the pixels of events and of constraints are far from each other.
  struct alignas(64) Pixel {
    LevelChanges::Pixel level;
    TimeNs t_ns = 0;                       ///< of the last event
    float log_intensity = 0;               ///< sum of the changes up to its last event
    float last_change = 0;                 ///< from the event before that
    float inverse_depth = 0;               ///< of the last reprojection; 0: none so far
    float x = 0, y = 0;                    ///< reprojection at its last event
    float observed_x = 0, observed_y = 0;  ///< reprojection at its last observation
    std::uint32_t run = 0;
    std::int32_t events = 0;         ///< of its run
    std::int32_t last_polarity = 0;  ///< of the last event, 0: none so far
  };
  /// The reprojection of a pixel before all events.
  struct Start {
    float x = kNowhere, y = kNowhere;
  };

  using Instant = typename Path::Instant;

  /// When no-event constraints are added.
  struct ConstraintTime {
    TimeNs t_ns;
    float fraction;  ///< of the way from one instant to the next
    int number;      ///< how many times they were added before
  };
  /// From one instant to the next.
  struct Step {
    Instant begin, end;
    bool is_first = false;  ///< there is only `end`
    std::vector<ConstraintTime> constraints;
  };
  /// The steps over some events, as many as take little memory, however long a time without events lasts.
  struct Batch {
    std::vector<Step> steps;
    std::span<const Event> events;
  };
  /// What is known of some rows, with the events of one batch.
  struct Band {
    PixelRows rows;
    std::uint32_t runs = 0;
    Events events;
    std::vector<IntensityObservation> observations;
  };

  void plan(std::span<const Event> events, std::size_t bands);
  void thin_constraints(std::span<const Event> events);
  void divide(std::span<const Event> events, std::size_t bands);
  /// The one that begins with `events`, which are all that are left; without steps where none is.
  [[nodiscard]] Batch next_batch(std::span<const Event> events,
                                 const Trajectory& world_from_camera);
  [[nodiscard]] Step first_step(const Trajectory& world_from_camera, TimeNs t_ns);
  void time_constraints(Step& step);
  void observe_band(std::span<const Step> steps, Band& band);
  void note_starts(const Instant& instant, PixelRows rows);
  void observe_event(const Event& event, const Step& step, Band& band);
  void add_event(const Event& event, const Reprojection& reprojection, Band& band);
  void add_no_event_constraints(const ConstraintTime& time, const Step& step, Band& band);
  void add_no_event_constraint(int x, int y, const Reprojection& reprojection, Band& band);

  Path path_;
  float contrast_on_, contrast_off_;
  float expected_;  ///< beyond the last event of a pixel [log units]
  LevelChanges changes_;
  ObservationOptions options_;
  std::array<ObservationKind, kKinds> kinds_;
  Image<Pixel> pixels_;
  Image<Start> starts_;
  std::vector<Band> bands_;
  std::vector<std::size_t> band_of_row_;
  Image<int> strides_;                     ///< of no-event constraints, by tile of the sensor
  std::optional<Instant> newest_;          ///< nullopt before the first step
  CameraPose constrained_from_reference_;  ///< the camera when constraints were added last
  int constrained_ = 0;                    ///< number of times they were
};

/// Observations of a view whose depth is known.
class SurfaceObservations : public ReprojectedObservations<SurfaceReprojection> {
 public:
  /// `reference_inverse_depth`: of the reference view. All but the options outlive the source.
  SurfaceObservations(const PinholeCamera& camera, const DepthScene& scene,
                      const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                      const ContrastThresholds& thresholds, const ObservationOptions& options)
      : ReprojectedObservations(SurfaceReprojection(camera, scene, world_from_reference,
                                                    reference_inverse_depth, options.reprojection),
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
