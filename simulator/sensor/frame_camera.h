#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_delivery.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/pixel/pixel_bank.h"
#include "simulator/sensor/pixel/pixel_noise.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/rays/ray_tracer.h"

namespace saccade {

/// The event camera that samples whole frames (ESIM; Rebecq, Gehrig and Scaramuzza, CoRL 2018,
/// section 3.3), the baseline for EventCamera. The frame after the one of time t_k comes at
///   t_(k+1) = t_k + lambda / max_u |V(u, t_k)|
/// with V the motion field [px/s] of everything in view and lambda = frames_lambda_px, or at
/// k / frames_rate_hz where that is set. Between two frames the log intensity of a pixel is the
/// straight line, on which the ideal pixel's crossings and all models of noise are exact. The times
/// are thus wrong by the curvature of the true signal, in second order of lambda, and at an edge
/// that hides another surface by the interval itself.
///
/// The stream is the same for any number of threads.
class FrameCamera {
 public:
  /// As EventCamera has it.
  FrameCamera(const Scene& scene, const Spline& world_from_camera, const PinholeCamera& camera,
              const EventOptions& options, std::uint64_t seed = 1);

  using Sink = EventDelivery::Sink;

  /// Records from time 0, or from where a resumed camera was, to `duration_s` > 0. Call once.
  /// One delivery per frame; state() may be called during it.
  void record(double duration_s, const Sink& sink);
  /// The first frame of record() that is not recorded yet.
  void step(double duration_s, const Sink& sink);
  [[nodiscard]] double reached_s() const { return t_s_; }

  [[nodiscard]] std::string state() const;
  /// Before record(); throws InputError where the state does not fit.
  void resume(std::string_view state);

  /// `time_bound_s`: the longest interval between two frames, the only bound there is.
  [[nodiscard]] EventStatistics statistics() const;

 private:
  using LogIntensities = std::array<double, kTilePixels>;
  /// A tile's fraction of the camera.
  struct TileState {
    explicit TileState(PixelBank bank) : pixels(std::move(bank)) {}

    PixelBank pixels;
    LogIntensities log_intensities{};  ///< log intensities in the last frame
    EventStatistics statistics;
    double fastest_px_s = 0;  ///< of what it saw in the last frame
  };
  struct Instant;

  [[nodiscard]] double next_frame_s(double duration_s) const;
  /// Renders the frame of `t_s` and calls done(tile_state, log intensities) for all tiles, in
  /// parallel.
  template <class Done>
  void render(double t_s, const Done& done);
  /// The log intensities of a tile, and how fast what it sees moves.
  [[nodiscard]] LogIntensities sample_tile(std::size_t tile, const Instant& instant,
                                           TileState& tile_state) const;
  static void start(TileState& tile_state, const LogIntensities& log_intensities);
  /// From the last frame to the one of `next_s`.
  void sense(TileState& tile_state, double next_s, const LogIntensities& log_intensities) const;

  const Scene& scene_;
  const Spline& motion_;
  PixelRays rays_;
  EventOptions options_;
  PixelNoise noise_;
  std::vector<TileState> tiles_;  ///< one per tile
  double t_s_ = 0;                ///< of the last frame
  std::uint64_t frames_ = 0;      ///< so far
  double fastest_px_s_ = 0;       ///< in the last frame
  double longest_s_ = 0;          ///< between two frames
  EventDelivery delivery_;
};

}  // namespace saccade
