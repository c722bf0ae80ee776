#include "simulator/sensor/frame_camera.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "simulator/sensor/image_motion.h"
#include "simulator/sensor/object_motion.h"
#include "simulator/sensor/tile_trace.h"

namespace saccade {
namespace {

/// Of two frames before a scene that hardly moves.
constexpr double kLongestInterval_s = 0.010;
constexpr std::size_t kTilesPerTask = 16;

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
      rays_(camera, options.samples_per_pixel),
      options_(options),
      seed_(seed),
      noise_(options, seed),
      delivery_(options, camera, seed) {
  blocks_.reserve(rays_.tile_count());
  for (std::size_t i = 0; i < rays_.tile_count(); ++i) blocks_.push_back(make_block(i));
}

FrameCamera::Block FrameCamera::make_block(std::size_t index) const {
  const Tile tile = rays_.tile(index);
  Block block;
  block.pixels.resize(tile.pixels());
  if (noise_.on()) block.noisy.resize(tile.pixels());
  for (std::size_t i = 0; i < tile.pixels(); ++i) {
    const auto x = static_cast<std::uint16_t>(tile.x(i));
    const auto y = static_cast<std::uint16_t>(tile.y(i));
    block.pixels[i].traits = pixel_traits(options_, seed_, x, y);
  }
  return block;
}

void FrameCamera::record(double duration_s, const Sink& sink) {
  SACCADE_CHECK(duration_s > 0 && t_s_ < duration_s);
  if (frames_ == 0)
    render(0, [&](Block& block, const Levels& levels) { start_pixels(block, levels); });
  while (t_s_ < duration_s) {
    const double next_s = next_frame_s(duration_s);
    render(next_s, [&](Block& block, const Levels& levels) {
      for (std::size_t i = 0; i < block.pixels.size(); ++i) sense(block, i, {next_s, levels[i]});
    });
    longest_s_ = std::max(longest_s_, next_s - t_s_);
    t_s_ = next_s;
    for (Block& block : blocks_) {
      delivery_.pending().insert(delivery_.pending().end(), block.events.begin(),
                                 block.events.end());
      block.events.clear();
    }
    delivery_.deliver(t_s_, t_s_ == duration_s, sink);
  }
}

double FrameCamera::next_frame_s(double duration_s) const {
  if (options_.frames_rate_hz > 0)
    return std::min(duration_s, static_cast<double>(frames_) / options_.frames_rate_hz);
  const double interval_s = std::clamp(options_.frames_lambda_px / fastest_px_s_,
                                       1e-6 * options_.time_tolerance_us, kLongestInterval_s);
  return std::min(duration_s, t_s_ + interval_s);
}

template <class Done>
void FrameCamera::render(double t_s, const Done& done) {
  const Instant instant(scene_, motion_.state(t_s), t_s);
  parallel_for(
      blocks_.size(), [&](std::size_t i) { done(blocks_[i], look(i, instant, blocks_[i])); },
      kTilesPerTask);
  fastest_px_s_ = 0;
  for (const Block& block : blocks_) fastest_px_s_ = std::max(fastest_px_s_, block.fastest_px_s);
  ++frames_;
}

FrameCamera::Levels FrameCamera::look(std::size_t tile, const Instant& instant,
                                      Block& block) const {
  const std::span<const Eigen::Vector3d> directions = rays_.rays(tile);
  const std::size_t per_pixel = rays_.rays_per_pixel();
  Levels levels{};
  block.fastest_px_s = 0;
  trace_tile(
      scene_, directions, instant.pose, [&](std::size_t k, const Ray& ray, TriangleId triangle) {
        const Eigen::Vector3d& direction = directions[k];
        const Shade shade =
            options_.texture_filter == TextureFilter::kBilinear
                ? scene_.shade(ray, triangle)
                : scene_.shade(ray, triangle, spread_in_world(rays_, instant.rotation, direction));
        levels[k / per_pixel] += shade.radiance;
        const Eigen::Vector2d motion = point_motion(rays_.camera(), direction, shade.distance,
                                                    instant.twists.before(triangle));
        block.fastest_px_s = std::max(block.fastest_px_s, motion.norm());
      });
  block.statistics.rays += directions.size();
  if (scene_.is_lit()) block.statistics.lit_points += directions.size();
  for (double& level : levels)
    level = std::log(options_.log_eps + level / static_cast<double>(per_pixel));
  return levels;
}

void FrameCamera::start_pixels(Block& block, const Levels& levels) const {
  for (std::size_t i = 0; i < block.pixels.size(); ++i) {
    Pixel& pixel = block.pixels[i];
    pixel.log_intensity = levels[i];
    pixel.state = start_pixel(pixel.traits, levels[i], 0);
    update_thresholds(pixel);
    if (!block.noisy.empty())
      block.noisy[i] = {NoisyState::kNotBlind,
                        noise_.spontaneous.start(pixel.traits.x, pixel.traits.y, 0),
                        PhotoreceptorFilter::settled(levels[i])};
  }
}

void FrameCamera::sense(Block& block, std::size_t i, const LinearSample& to) const {
  Pixel& pixel = block.pixels[i];
  const LinearSample from{t_s_, pixel.log_intensity};
  pixel.log_intensity = to.log_intensity;
  ++block.statistics.stretches;
  if (block.noisy.empty() && pixel.thresholds.band().holds(pixel.thresholds.signal(to))) {
    ++block.statistics.certified;
    return;
  }
  const auto emit = [&](double t_s, int polarity, EventOrigin origin, double log_intensity) {
    const TimeNs step_ns = options_.timestamp_step_ns();
    const auto steps = static_cast<TimeNs>(std::llround(t_s * 1e9 / static_cast<double>(step_ns)));
    block.events.push_back({steps * step_ns, pixel.traits.x, pixel.traits.y,
                            static_cast<std::int8_t>(polarity), origin,
                            static_cast<float>(log_intensity)});
  };
  const LinearSignal signal(options_.log_eps, 1e-6 * options_.time_tolerance_us);
  PixelSensor sensor(signal, pixel.traits, options_.log_eps, pixel.state, pixel.thresholds, emit);
  if (block.noisy.empty())
    sensor.sense(from, to);
  else if (noise_.filter.on())
    sensor.sense_filtered(from, to, noise_, block.noisy[i]);
  else
    sensor.sense(from, to, noise_, block.noisy[i]);
}

std::string FrameCamera::state() const {
  StateWriter state;
  state.value(t_s_);
  state.value(frames_);
  state.value(fastest_px_s_);
  state.value(longest_s_);
  for (const Block& block : blocks_) {
    for (const Pixel& pixel : block.pixels) {
      state.value(pixel.state);
      state.value(pixel.log_intensity);
    }
    state.values(block.noisy);
    state.value(block.statistics);
  }
  delivery_.save(state);
  return state.take();
}

void FrameCamera::resume(std::string_view bytes) {
  StateReader state(bytes);
  state.value(t_s_);
  state.value(frames_);
  state.value(fastest_px_s_);
  state.value(longest_s_);
  for (Block& block : blocks_) {
    for (Pixel& pixel : block.pixels) {
      state.value(pixel.state);
      state.value(pixel.log_intensity);
      update_thresholds(pixel);
    }
    state.values(block.noisy);
    state.value(block.statistics);
  }
  delivery_.load(state);
  if (!state.at_end()) throw InputError("saved state", "is too long; start the simulation afresh");
}

EventStatistics FrameCamera::statistics() const {
  EventStatistics total;
  for (const Block& block : blocks_) total.add(block.statistics);
  total.lost = delivery_.lost();
  total.time_bound_s = longest_s_;
  return total;
}

}  // namespace saccade
