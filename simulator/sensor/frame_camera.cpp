#include "simulator/sensor/frame_camera.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/scene/light/flicker.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/motion/object_motion.h"
#include "simulator/sensor/rays/tile_trace.h"
#include "simulator/sensor/signal/linear_signal.h"

namespace saccade {
namespace {

/// Of two frames before a scene that hardly moves.
constexpr double kLongestInterval_s = 0.010;
/// Of two frames under a flickering light [periods].
constexpr double kPeriodFraction = 1.0 / 16;

}  // namespace

/// The camera at the time of a frame.
struct FrameCamera::Instant {
  StampedPose pose;
  Eigen::Matrix3d rotation;
  RelativeTwists twists;

  Instant(const Scene& scene, const SplineState& state, double t_s)
      : pose{t_s, state.world_from_body},
        rotation(state.world_from_body.rotation_matrix()),
        twists(scene, state, t_s) {}
};

FrameCamera::FrameCamera(const Scene& scene, const Spline& world_from_camera,
                         const PinholeCamera& camera, const EventOptions& options,
                         std::uint64_t seed)
    : scene_(scene),
      motion_(world_from_camera),
      rays_(camera, options.samples_per_pixel, options.pixel_side),
      options_(options),
      noise_(options, seed),
      delivery_(options, camera, seed) {
  tiles_.reserve(rays_.tile_count());
  for (std::size_t i = 0; i < rays_.tile_count(); ++i)
    tiles_.emplace_back(PixelBank(options_, noise_, seed, rays_.tile(i)));
}

void FrameCamera::record(double duration_s, const Sink& sink) {
  SACCADE_CHECK(duration_s > 0 && t_s_ < duration_s);
  while (t_s_ < duration_s) step(duration_s, sink);
}

void FrameCamera::step(double duration_s, const Sink& sink) {
  if (frames_ == 0)
    render(0, [](TileState& tile_state, const LogIntensities& log_intensities) {
      start(tile_state, log_intensities);
    });
  const double next_s = next_frame_s(duration_s);
  render(next_s, [&](TileState& tile_state, const LogIntensities& log_intensities) {
    sense(tile_state, next_s, log_intensities);
  });
  longest_s_ = std::max(longest_s_, next_s - t_s_);
  t_s_ = next_s;
  for (TileState& tile_state : tiles_) tile_state.pixels.take_events(delivery_.pending());
  delivery_.deliver(t_s_, t_s_ == duration_s, sink);
}

double FrameCamera::next_frame_s(double duration_s) const {
  if (options_.frames_rate_hz > 0)
    return std::min(duration_s, static_cast<double>(frames_) / options_.frames_rate_hz);
  const double longest_s =
      std::min(kLongestInterval_s, kPeriodFraction * shortest_period_s(scene_.flickers()));
  const double interval_s = std::min(longest_s, std::max(options_.frames_lambda_px / fastest_px_s_,
                                                         1e-6 * options_.time_tolerance_us));
  return std::min(duration_s, t_s_ + interval_s);
}

template <class Done>
void FrameCamera::render(double t_s, const Done& done) {
  const Instant instant(scene_, motion_.state(t_s), t_s);
  parallel_for(
      tiles_.size(), [&](std::size_t i) { done(tiles_[i], sample_tile(i, instant, tiles_[i])); },
      kTilesPerTask);
  fastest_px_s_ = 0;
  for (const TileState& tile_state : tiles_)
    fastest_px_s_ = std::max(fastest_px_s_, tile_state.fastest_px_s);
  ++frames_;
}

FrameCamera::LogIntensities FrameCamera::sample_tile(std::size_t tile, const Instant& instant,
                                                     TileState& tile_state) const {
  const std::span<const Eigen::Vector3d> directions = rays_.rays(tile);
  const std::size_t per_pixel = rays_.rays_per_pixel();
  LogIntensities log_intensities{};
  tile_state.fastest_px_s = 0;
  trace_tile(scene_, directions, instant.pose,
             [&](std::size_t k, const Ray& ray, TriangleId triangle) {
               const Eigen::Vector3d& direction = directions[k];
               const Shade shade =
                   options_.texture_filter == TextureFilter::kBilinear
                       ? scene_.shade(ray, triangle)
                       : scene_.shade(ray, triangle,
                                      differential_in_world(rays_, instant.rotation, direction));
               log_intensities[k / per_pixel] += shade.radiance;
               tile_state.fastest_px_s =
                   std::max(tile_state.fastest_px_s,
                            instant.twists.fastest_px_s(rays_.camera(), direction, shade.distance,
                                                        ray, triangle, kLongestInterval_s));
             });
  tile_state.statistics.rays += directions.size();
  if (scene_.is_lit()) tile_state.statistics.lit_points += directions.size();
  for (double& value : log_intensities)
    value = std::log(options_.log_eps + value / static_cast<double>(per_pixel));
  return log_intensities;
}

void FrameCamera::start(TileState& tile_state, const LogIntensities& log_intensities) {
  for (std::size_t i = 0; i < tile_state.pixels.size(); ++i)
    tile_state.pixels.start(i, log_intensities[i], 0);
  tile_state.log_intensities = log_intensities;
}

void FrameCamera::sense(TileState& tile_state, double next_s,
                        const LogIntensities& log_intensities) const {
  const LinearSignal signal(options_.log_eps, 1e-6 * options_.time_tolerance_us);
  for (std::size_t i = 0; i < tile_state.pixels.size(); ++i) {
    const LinearSample to{next_s, log_intensities[i]};
    const Thresholds& thresholds = tile_state.pixels.thresholds(i);
    if (tile_state.pixels.is_noisy() || !thresholds.band().contains(thresholds.signal(to)))
      tile_state.pixels.sense(i, signal, {t_s_, tile_state.log_intensities[i]}, to);
  }
  tile_state.log_intensities = log_intensities;
}

std::string FrameCamera::state() const {
  StateWriter state;
  state.value(t_s_);
  state.value(frames_);
  state.value(fastest_px_s_);
  state.value(longest_s_);
  for (const TileState& tile_state : tiles_) {
    tile_state.pixels.save(state);
    state.value(tile_state.log_intensities);
    state.value(tile_state.statistics);
  }
  delivery_.save(state);
  return state.bytes();
}

void FrameCamera::resume(std::string_view bytes) {
  StateReader state(bytes);
  state.value(t_s_);
  state.value(frames_);
  state.value(fastest_px_s_);
  state.value(longest_s_);
  for (TileState& tile_state : tiles_) {
    tile_state.pixels.load(state);
    state.value(tile_state.log_intensities);
    state.value(tile_state.statistics);
  }
  delivery_.load(state);
  if (!state.at_end()) throw InputError("saved state", "is too long; start the simulation afresh");
}

EventStatistics FrameCamera::statistics() const {
  EventStatistics total;
  for (const TileState& tile_state : tiles_) total.add(tile_state.statistics);
  total.lost = delivery_.lost();
  total.time_bound_s = longest_s_;
  return total;
}

}  // namespace saccade
