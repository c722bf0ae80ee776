#include "simulator/sensor/event_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/scene/moving_object.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/motion/object_motion.h"

namespace saccade {
namespace {

constexpr double kLongestSlice_s = 0.030;
constexpr double kShortestSlice_s = 1e-4;
/// From so far around a tile things come into its view within a slice [px]; whole tiles.
constexpr int kReach_px = 8;
/// Where surfaces slide over one another, at more than this fraction of their motion, one can show
/// for less than a step behind another's edge; the steps there are shorter.
constexpr double kOccluding = 0.15;
constexpr double kOccludedStepDivisor = 2;
/// Half the diagonal of a square.
constexpr double kHalfDiagonal = 0.70711;

/// Large tiles share more of what is found out about them; where only some sense, or pixels have
/// many rays, small ones are enough.
int tile_size(const EventOptions& options, std::span<const std::size_t> only) {
  return only.empty() && options.samples_per_pixel == 1 ? kLargeTileSize : kTileSize;
}

}  // namespace

EventCamera::EventCamera(const Scene& scene, const Spline& world_from_camera,
                         const PinholeCamera& camera, const EventOptions& options,
                         std::uint64_t seed, std::span<const std::size_t> only)
    : motion_(world_from_camera),
      rays_(camera, options.samples_per_pixel, options.pixel_side, tile_size(options, only)),
      world_{scene, rays_, options, seed, PixelNoise(options, seed)},
      motions_(rays_.tile_count()),
      delivery_(options, camera, seed) {
  SACCADE_CHECK(!scene.is_animated());  // its proofs are of rigid bodies
  make_tiles(only);
}

void EventCamera::make_tiles(std::span<const std::size_t> only) {
  tiles_.resize(rays_.tile_count());
  senses_.assign(rays_.tile_count(), only.empty());
  for (const std::size_t i : only) senses_[i] = true;
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    if (senses_[i]) tiles_[i] = make_event_tile(world_, i);
  for (const std::size_t i : only)
    for_each_around(i, [&](std::size_t near) {
      if (tiles_[near] == nullptr) tiles_[near] = make_depth_tile(world_, near);
    });
}

void EventCamera::record(double duration_s, const Sink& sink) {
  SACCADE_CHECK(duration_s > 0 && t_s_ < duration_s);
  while (t_s_ < duration_s) step(duration_s, sink);
}

void EventCamera::step(double duration_s, const Sink& sink) {
  take_slice(duration_s);
  delivery_.deliver(t_s_, t_s_ == duration_s, sink);
}

void EventCamera::step_until(double until_s, const Sink& sink) {
  take_slice(until_s);
  delivery_.deliver(t_s_, false, sink);
}

void EventCamera::take_slice(double until_s) {
  sense_slice(until_s);
  for (const auto& tile : tiles_)
    if (tile != nullptr) tile->take_events(delivery_.pending());
}

void EventCamera::advance(double duration_s, const Take& take) {
  sense_slice(duration_s);
  SensedEvents events;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    if (!senses_[i]) continue;
    events.clear();
    tiles_[i]->take_events(events);
    take(i, events);
  }
}

void EventCamera::sense_slice(double duration_s) {
  if (!started_) {
    const SplineTable first(motion_, 0, std::min(kLongestSlice_s, duration_s));
    for_each_tile([&](EventTile& tile, std::size_t) { tile.start(first, 0); });
    started_ = true;
  }
  const double fastest = bound_speeds(t_s_);
  const double slice_s = std::clamp(kReach_px / fastest, kShortestSlice_s, kLongestSlice_s);
  const double until_s = next_motion_change_s(duration_s);
  // No sliver at the end: the rest is split evenly.
  const double slices_left = std::ceil((until_s - t_s_) / slice_s);
  const double end_s = slices_left <= 1 ? until_s : t_s_ + (until_s - t_s_) / slices_left;
  const SplineTable poses(motion_, t_s_, end_s);
  for_each_tile([&](EventTile& tile, std::size_t i) {
    TileMotion motion = motions_[i];
    motion.pixels *= end_s - t_s_;
    tile.advance({poses, end_s}, motion);
  });
  t_s_ = end_s;
}

double EventCamera::next_motion_change_s(double duration_s) const {
  double until_s = duration_s;
  for (const MovingObject& object : world_.scene.moving_objects())
    for (const double kink_s : {object.start_s(), object.end_s()})
      if (kink_s > t_s_ && kink_s < until_s) until_s = kink_s;
  return until_s;
}

std::string EventCamera::state() const {
  StateWriter state;
  state.value(t_s_);
  for (const auto& tile : tiles_)
    if (tile != nullptr) tile->save(state);
  delivery_.save(state);
  return state.bytes();
}

void EventCamera::resume(std::string_view bytes) {
  StateReader state(bytes);
  state.value(t_s_);
  for (const auto& tile : tiles_)
    if (tile != nullptr) tile->load(state);
  delivery_.load(state);
  if (!state.at_end()) throw InputError("saved state", "is too long; start the simulation afresh");
  started_ = true;
}

template <class Work>
void EventCamera::for_each_tile(const Work& work) {
  parallel_for(
      tiles_.size(),
      [&](std::size_t i) {
        if (tiles_[i] != nullptr) work(*tiles_[i], i);
      },
      kTilesPerTask);
}

double EventCamera::bound_speeds(double t_s) {
  // The motion changes little within 5 ms, so that a few samples bound it.
  std::array<Twist, 7> twists;
  for (std::size_t k = 0; k < twists.size(); ++k)
    twists[k] = camera_twist(motion_.state(t_s + static_cast<double>(k) * kLongestSlice_s / 6));
  const PinholeCamera& camera = rays_.camera();
  const double side = rays_.tile_size();
  const ObjectMotion objects(world_.scene, motion_, t_s, t_s + kLongestSlice_s);
  for_each_tile([&](EventTile&, std::size_t i) {
    if (!senses_[i]) return;
    const Tile tile = rays_.tile(i);
    const Eigen::Vector3d centre =
        camera.ray(Eigen::Vector2d(tile.x0 + 0.5 * (side - 1), tile.y0 + 0.5 * (side - 1)));
    const InverseDepthRange range = neighbourhood(i);
    ImageSpeed speed = objects.bound(camera, centre, kHalfDiagonal * (side + 2 * kReach_px), range);
    motions_[i].has_objects = speed.fastest > 0;
    for (const Twist& twist : twists) {
      const ImageSpeed now = image_speed_bound(camera, centre, kHalfDiagonal * side, twist, range);
      speed.fastest = std::max(speed.fastest, now.fastest);
      speed.parallax = std::max(speed.parallax, now.parallax);
    }
    motions_[i].pixels = speed.fastest;
    motions_[i].farthest_m = 1 / range.low;
    motions_[i].step_divisor =
        speed.parallax > kOccluding * speed.fastest ? kOccludedStepDivisor : 1;
  });
  double fastest = 0;
  for (const TileMotion& motion : motions_) fastest = std::max(fastest, motion.pixels);
  return fastest;
}

template <class Use>
void EventCamera::for_each_around(std::size_t tile, const Use& use) const {
  const int tx = static_cast<int>(tile) % rays_.tiles_x();
  const int ty = static_cast<int>(tile) / rays_.tiles_x();
  const int rings = kReach_px / rays_.tile_size();
  for (int y = std::max(0, ty - rings); y <= std::min(ty + rings, rays_.tiles_y() - 1); ++y)
    for (int x = std::max(0, tx - rings); x <= std::min(tx + rings, rays_.tiles_x() - 1); ++x)
      use(static_cast<std::size_t>(y * rays_.tiles_x() + x));
}

InverseDepthRange EventCamera::neighbourhood(std::size_t tile) const {
  InverseDepthRange range{std::numeric_limits<double>::infinity(), 0};
  for_each_around(tile, [&](std::size_t around) {
    const InverseDepthRange near = tiles_[around]->inverse_depths();
    range.low = std::min(range.low, near.low);
    range.high = std::max(range.high, near.high);
  });
  return range;
}

EventStatistics EventCamera::statistics() const {
  EventStatistics total;
  for (const auto& tile : tiles_)
    if (tile != nullptr) total.add(tile->statistics());
  total.lost = delivery_.lost();
  return total;
}

}  // namespace saccade
