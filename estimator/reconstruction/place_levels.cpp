#include "estimator/reconstruction/place_levels.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr std::size_t kBatch = 512;  ///< events between two looks at how far the camera has moved

constexpr TimeNs kAtOnceNs = 2000;

/// Of the square of the furthest motion: a silent pixel that has moved less has nothing to add.
constexpr double kLeastShare = 0.25;

}  // namespace

LevelFinder::LevelFinder(const PinholeCamera& camera, const DepthScene& scene,
                         const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                         double contrast_on, double contrast_off, const LevelOptions& options)
    : places_(camera, scene, world_from_reference, reference_inverse_depth, options.places),
      world_from_reference_(world_from_reference),
      contrast_on_(static_cast<float>(contrast_on)),
      contrast_off_(static_cast<float>(contrast_off)),
      options_(options),
      pixels_(camera.width, camera.height) {}

void LevelFinder::find(std::span<const Event> events, const Trajectory& world_from_camera,
                       std::vector<PlaceLevel>& levels) {
  if (events.empty()) return;
  const PoseTable poses(world_from_camera, world_from_reference_.inverse(), events.front().t_ns,
                        events.back().t_ns);
  for (std::size_t i = 0; i < events.size(); ++i) {
    const CameraPose pose = poses.at(events[i].t_ns);
    if (i % kBatch == 0) {
      places_.prepare(pose);
      if (options_.still &&
          (asked_ == 0 || places_.moved_px(pose, asked_from_reference_) >= options_.still_px))
        ask_still(pose, levels);
    }
    add_event(events[i], pose, levels);
  }
  if (options_.still) ask_still(poses.at(events.back().t_ns), levels);
}

void LevelFinder::add_event(const Event& event, const CameraPose& pose,
                            std::vector<PlaceLevel>& levels) {
  Pixel& pixel = pixels_(event.x, event.y);
  const float step = event.polarity > 0 ? contrast_on_ : -contrast_off_;
  pixel.level += step;
  const auto place = find_place(event.x, event.y, pose);
  if (!place) return;
  // At the edge of an occluder the level jumps past the threshold, by up to one more of them; so do
  // several events at once.
  const auto tolerance = static_cast<float>(options_.places.same_surface);
  const bool is_jump = pixel.events > 0 && (std::abs(place->inverse_depth - pixel.inverse_depth) >
                                                tolerance * pixel.inverse_depth ||
                                            event.t_ns - pixel.t_ns < kAtOnceNs);
  const auto sigma = static_cast<float>(options_.event_sigma);
  const float deviation = is_jump ? std::hypot(sigma, step) : sigma;
  if (pixel.events == 0 || pixel.events >= options_.track_events) {
    if (pixel.events > 0)
      levels.push_back({tracks_, pixel.x, pixel.y, pixel.level - step, sigma, 0, 0});
    pixel.track = tracks_++;
    pixel.events = 0;
  }
  levels.push_back({pixel.track, place->x, place->y, pixel.level, deviation, 0, 0});
  pixel = {pixel.level,      place->inverse_depth,
           place->x,         place->y,
           place->x,         place->y,
           event.t_ns,       pixel.track,
           pixel.events + 1, static_cast<float>(event.polarity)};
}

void LevelFinder::ask_still(const CameraPose& pose, std::vector<PlaceLevel>& levels) {
  asked_from_reference_ = inverse_of(pose);
  // Neighbours in both directions have different turns, so that no place is left out.
  const int turns = options_.still_turns;
  for (int y = 0; y < pixels_.height(); ++y)
    for (int x = (asked_ + (turns / 2) * y) % turns; x < pixels_.width(); x += turns)
      add_still(x, y, pose, levels);
  ++asked_;
}

void LevelFinder::add_still(int x, int y, const CameraPose& pose, std::vector<PlaceLevel>& levels) {
  // What passed a pixel most often are edges: the level went on, past that of the last event, by up
  // to a threshold (C / 2 +- C / sqrt(12)). Without an event so far it may be on either side.
  const float contrast = (contrast_on_ + contrast_off_) / 2;
  Pixel& pixel = pixels_(x, y);
  const auto place = find_place(x, y, pose);
  if (!place) return;
  if (pixel.events == 0) {
    pixel.track = tracks_++;
    pixel.events = 1;
  } else if (const float moved_x = place->x - pixel.still_x, moved_y = place->y - pixel.still_y;
             static_cast<double>(moved_x * moved_x + moved_y * moved_y) <
             kLeastShare * options_.still_px * options_.still_px) {
    return;
  }
  const float beyond = pixel.last * contrast * static_cast<float>(options_.beyond);
  const float deviation = contrast / std::sqrt(pixel.last == 0 ? 3.0F : 12.0F);
  levels.push_back({pixel.track, place->x, place->y, pixel.level, deviation, contrast, beyond});
  pixel.still_x = place->x;
  pixel.still_y = place->y;
}

std::optional<Place> LevelFinder::find_place(int x, int y, const CameraPose& pose) const {
  const Pixel& pixel = pixels_(x, y);
  if (pixel.events == 0) return places_.find(x, y, pose);
  const Eigen::Vector2f earlier(pixel.still_x, pixel.still_y);
  return places_.find(x, y, pose, &earlier);
}

}  // namespace saccade
