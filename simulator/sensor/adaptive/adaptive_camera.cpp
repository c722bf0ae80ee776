#include "simulator/sensor/adaptive/adaptive_camera.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/scene/moving_object.h"

namespace saccade {
namespace {

constexpr double kShortestSlice_s = 1e-4;
/// What moves by at most this in a slice comes from the tiles next to its own.
constexpr double kSliceMotion_px = kTileSize;

}  // namespace

AdaptiveCamera::AdaptiveCamera(const Scene& scene, const Spline& world_from_camera,
                               const PinholeCamera& camera, const EventOptions& options,
                               std::uint64_t seed)
    : scene_(scene),
      motion_(world_from_camera),
      options_(options),
      rays_(camera, options.samples_per_pixel, options.pixel_side),
      noise_(options, seed),
      delivery_(options, camera, seed),
      audit_(scene, world_from_camera, camera, options, seed) {
  tiles_.reserve(rays_.tile_count());
  for (std::size_t i = 0; i < rays_.tile_count(); ++i)
    tiles_.push_back(std::make_unique<AdaptiveTile>(scene_, rays_, options_, noise_, seed, i));
}

void AdaptiveCamera::record(double duration_s, const Sink& sink) {
  SACCADE_CHECK(duration_s > 0 && t_s_ < duration_s);
  while (t_s_ < duration_s) step(duration_s, sink);
}

void AdaptiveCamera::step(double duration_s, const Sink& sink) {
  const double end_s = slice_end_s(duration_s);
  const SplineTable poses(motion_, t_s_, end_s);
  const RelativeTwists first(scene_, motion_.state(t_s_), t_s_);
  const RelativeTwists last(scene_, motion_.state(end_s), end_s);
  const AdaptiveSlice slice{poses, t_s_, end_s, first, last};
  if (!started_)
    parallel_for(
        tiles_.size(), [&](std::size_t i) { tiles_[i]->start(slice); }, kTilesPerTask);
  started_ = true;
  std::vector<Surroundings> own(tiles_.size());
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    own[i] = {tiles_[i]->speed_px_s(), tiles_[i]->has_edges()};
  parallel_for(
      tiles_.size(), [&](std::size_t i) { tiles_[i]->advance(slice, around(i, own)); },
      kTilesPerTask);
  audit_.sense(slice, [&](std::size_t i) { return around(i, own).speed_px_s; });
  t_s_ = end_s;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const std::size_t before = delivery_.pending().size();
    tiles_[i]->take_events(delivery_.pending());
    audit_.add(i, std::span(delivery_.pending()).subspan(before));
  }
  audit_.advance(t_s_, duration_s);
  delivery_.deliver(t_s_, t_s_ == duration_s, sink);
}

double AdaptiveCamera::slice_end_s(double duration_s) const {
  double until_s = duration_s;
  for (const MovingObject& object : scene_.moving_objects())
    for (const double kink_s : {object.start_s(), object.end_s()})
      if (kink_s > t_s_ && kink_s < until_s) until_s = kink_s;
  double fastest = 0;
  for (const auto& tile : tiles_) fastest = std::max(fastest, tile->speed_px_s());
  const double slice_s = started_ ? std::clamp(kSliceMotion_px / std::max(fastest, 1e-9),
                                               kShortestSlice_s, AdaptiveSlice::kLongest_s)
                                  : kShortestSlice_s;
  const double slices_left = std::ceil((until_s - t_s_) / slice_s);
  return slices_left <= 1 ? until_s : t_s_ + (until_s - t_s_) / slices_left;
}

Surroundings AdaptiveCamera::around(std::size_t tile,
                                    const std::vector<Surroundings>& tiles) const {
  const int tx = static_cast<int>(tile) % rays_.tiles_x();
  const int ty = static_cast<int>(tile) / rays_.tiles_x();
  Surroundings all{0, false};
  for (int y = std::max(0, ty - 1); y <= std::min(ty + 1, rays_.tiles_y() - 1); ++y)
    for (int x = std::max(0, tx - 1); x <= std::min(tx + 1, rays_.tiles_x() - 1); ++x) {
      const Surroundings& each = tiles[static_cast<std::size_t>(y * rays_.tiles_x() + x)];
      all.speed_px_s = std::max(all.speed_px_s, each.speed_px_s);
      all.have_edges = all.have_edges || each.have_edges;
    }
  return all;
}

std::string AdaptiveCamera::state() const {
  StateWriter state;
  state.value(t_s_);
  for (const auto& tile : tiles_) tile->save(state);
  delivery_.save(state);
  audit_.save(state);
  return state.bytes();
}

void AdaptiveCamera::resume(std::string_view bytes) {
  StateReader state(bytes);
  state.value(t_s_);
  for (auto& tile : tiles_) tile->load(state);
  delivery_.load(state);
  audit_.load(state);
  if (!state.at_end()) throw InputError("saved state", "is too long; start the simulation afresh");
  started_ = true;
}

EventStatistics AdaptiveCamera::statistics() const {
  EventStatistics total;
  for (const auto& tile : tiles_) total.add(tile->statistics());
  total.lost = delivery_.lost();
  return total;
}

}  // namespace saccade
