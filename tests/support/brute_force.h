#pragma once

#include <span>
#include <string>

#include "core/camera.h"
#include "core/event.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/event_tile.h"

namespace saccade::testing {

/// What the ideal event camera must agree with, made without any of its shortcuts: every ray of
/// every pixel is traced and shaded on a grid of `step_s` <= 10 us, at the spline's own poses. What
/// can hide between two grid times is looked for:
///   - where a ray moves over its texture by more than 0.1 texel, the step is halved until it does
///     not (minified texture under grazing rays);
///   - where a visible triangle differs, each change is bisected to a nanosecond, with visibility
///     in double precision (Scene::visible_exactly); what is then seen for less than a tenth of a
///     microsecond counts for nothing, because rays slip through between triangles that touch but
///     share no corners;
///   - where the signal turns back next to a threshold, its extremum is searched.
/// Crossings are bisected to a nanosecond. Sorted. Of `options` the thresholds, eps and the rays
/// per pixel count.
[[nodiscard]] Events brute_force(const Scene& scene, const Spline& motion,
                                 const PinholeCamera& camera, const EventOptions& options,
                                 double step_s = 1e-5);

/// Log intensity of one pixel at any times.
[[nodiscard]] std::vector<double> log_intensities(const Scene& scene, const Spline& motion,
                                                  const PinholeCamera& camera, int x, int y,
                                                  const EventOptions& options,
                                                  std::span<const double> times_s);

/// Events of `a` and `b` that pair up one-to-one, in order, within `tolerance_ns`, per pixel and
/// polarity.
[[nodiscard]] std::size_t count_pairs(const Events& a, const Events& b, TimeNs tolerance_ns);

/// A stream held against the true one.
struct Agreement {
  std::size_t found = 0;
  std::size_t expected = 0;
  std::size_t at_10_us = 0;  ///< pairs
  std::size_t at_1_us = 0;
  EventStatistics statistics;

  /// Smaller one of precision and recall; 1 without any events.
  [[nodiscard]] double share_10_us() const { return share(at_10_us); }
  [[nodiscard]] double share_1_us() const { return share(at_1_us); }
  [[nodiscard]] double rays_per_event() const;
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] double share(std::size_t pairs) const;
};

/// Records `motion` with the event camera.
struct Recorded {
  Events events;
  EventStatistics statistics;
};
[[nodiscard]] Recorded record(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                              const EventOptions& options);

/// The event camera, in nanoseconds, held against brute force on a grid of `step_s`.
[[nodiscard]] Agreement agreement(const Scene& scene, const Spline& motion,
                                  const PinholeCamera& camera, EventOptions options,
                                  double step_s = 1e-5);

/// How far the image moves: the motion field's norm integrated over the motion, mean over all
/// pixels [px].
[[nodiscard]] double mean_path_px(const Scene& scene, const Spline& motion,
                                  const PinholeCamera& camera);

/// Greatest excess of |L_hat - L| over the threshold at times `step_s` apart over all pixels, where
/// L_hat is the first value plus the events' steps; events within `tolerance_s` of a time may count
/// for it or not. <= 0 for a stream that reconstructs its signal [log units].
[[nodiscard]] double reconstruction_excess(const Scene& scene, const Spline& motion,
                                           const PinholeCamera& camera, const EventOptions& options,
                                           const Events& events, double step_s, double tolerance_s);

}  // namespace saccade::testing
