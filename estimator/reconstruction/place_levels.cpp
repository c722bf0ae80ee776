#include "estimator/reconstruction/place_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stopwatch.h"

namespace saccade {
namespace {

constexpr std::size_t kBatch = 65536;  ///< events whose levels are found at a time

constexpr int kTile = 16;  ///< in which silent pixels take equal turns [px]

constexpr TimeNs kAtOnceNs = 2000;

/// Of the square of the furthest motion: a silent pixel that has moved less has nothing to add.
constexpr double kLeastShare = 0.25;

}  // namespace

double LevelFinder::find_all(std::span<const Event> events, const Trajectory& world_from_camera,
                             const std::function<void(std::span<const PlaceLevel>, double)>& use) {
  double seconds = 0;
  expect(events);
  std::vector<PlaceLevel> part;
  for (std::size_t begin = 0; begin < events.size(); begin += kBatch) {
    part.clear();
    const std::size_t count = std::min(kBatch, events.size() - begin);
    {
      const ScopedTimer clock(seconds);
      find(events.subspan(begin, count), world_from_camera, part);
    }
    use(part, static_cast<double>(begin + count) / static_cast<double>(events.size()));
  }
  return seconds;
}

template <class Places>
PlaceLevels<Places>::PlaceLevels(Places places, const PinholeCamera& camera, double contrast_on,
                                 double contrast_off, const LevelOptions& options)
    : places_(std::move(places)),
      contrast_on_(static_cast<float>(contrast_on)),
      contrast_off_(static_cast<float>(contrast_off)),
      options_(options),
      pixels_(camera.width, camera.height),
      turns_((camera.width - 1) / kTile + 1, (camera.height - 1) / kTile + 1, options.still_turns) {
  // At the edge of an occluder the level jumps past the threshold, by up to one more of them; so do
  // several events at once. What passed a silent pixel most often are edges: its level went on,
  // past that of the last event, by up to a threshold (C / 2 +- C / sqrt(12)). Without an event so
  // far it may be on either side.
  const auto sigma = static_cast<float>(options.event_sigma);
  const float contrast = (contrast_on_ + contrast_off_) / 2;
  const float beyond = contrast * static_cast<float>(options.beyond);
  sorts_[kEvent] = {sigma, 0, 0};
  sorts_[kJumpUp] = {std::hypot(sigma, contrast_on_), 0, 0};
  sorts_[kJumpDown] = {std::hypot(sigma, contrast_off_), 0, 0};
  sorts_[kSilent] = {contrast / std::sqrt(3.0F), contrast, 0};
  sorts_[kSilentUp] = {contrast / std::sqrt(12.0F), contrast, beyond};
  sorts_[kSilentDown] = {contrast / std::sqrt(12.0F), contrast, -beyond};
}

template <class Places>
void PlaceLevels<Places>::expect(std::span<const Event> events) {
  Image<int> counts(turns_.width(), turns_.height());
  for (const Event& event : events) ++counts(event.x / kTile, event.y / kTile);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double share = counts.pixels()[i] / (options_.still_events * kTile * kTile);
    turns_.pixels()[i] = static_cast<int>(options_.still_turns * std::max(share, 1.0));
  }
}

template <class Places>
void PlaceLevels<Places>::find(std::span<const Event> events, const Trajectory& world_from_camera,
                               std::vector<PlaceLevel>& levels) {
  if (events.empty()) return;
  if (asked_ == 0) {
    places_.start(world_from_camera, events.front().t_ns);
    ask_still(levels);
  }
  const TimeNs last_ns = events.back().t_ns;
  for (std::size_t i = 0; i < events.size();) {
    places_.advance(world_from_camera, last_ns);
    for (; i < events.size() && events[i].t_ns <= places_.end_ns(); ++i) {
      pixels_(events[i].x, events[i].y).level +=
          events[i].polarity > 0 ? contrast_on_ : -contrast_off_;
      if (const auto place = places_.of(events[i])) add_event(events[i], *place, levels);
    }
    if (options_.still && places_.moved_px(asked_from_reference_) >= 0.9 * options_.still_px)
      ask_still(levels);
  }
}

template <class Places>
void PlaceLevels<Places>::add_event(const Event& event, const Place& place,
                                    std::vector<PlaceLevel>& levels) {
  Pixel& pixel = pixels_(event.x, event.y);
  const auto tolerance = static_cast<float>(options_.places.same_surface);
  const bool is_up = event.polarity > 0;
  const bool is_jump = pixel.events > 0 && (std::abs(place.inverse_depth - pixel.inverse_depth) >
                                                tolerance * pixel.inverse_depth ||
                                            event.t_ns - pixel.t_ns < kAtOnceNs);
  if (pixel.events == 0 || pixel.events >= options_.track_events) {
    const std::uint32_t earlier_events = static_cast<std::uint32_t>(pixel.events);
    pixel.track = tracks_++;
    if (earlier_events > 0)
      levels.push_back({pixel.x, pixel.y, pixel.level - (is_up ? contrast_on_ : -contrast_off_),
                        PlaceLevel::tag(pixel.track, kEvent)});
    pixel.events = 0;
  }
  const Sort sort = !is_jump ? kEvent : is_up ? kJumpUp : kJumpDown;
  levels.push_back({place.x, place.y, pixel.level, PlaceLevel::tag(pixel.track, sort)});
  pixel.inverse_depth = place.inverse_depth;
  pixel.x = pixel.still_x = place.x;
  pixel.y = pixel.still_y = place.y;
  pixel.t_ns = event.t_ns;
  ++pixel.events;
  pixel.last = event.polarity;
}

template <class Places>
void PlaceLevels<Places>::ask_still(std::vector<PlaceLevel>& levels) {
  asked_from_reference_ = inverse_of(places_.end_pose());
  // Neighbours in both directions have different turns, so that no place is left out.
  const int width = pixels_.width();
  for (int y = 0; y < pixels_.height() && options_.still; ++y)
    for (int left = 0; left < width; left += kTile) {
      const int turns = turns_(left / kTile, y / kTile);
      const int right = std::min(left + kTile, width);
      const int shift = (asked_ + (turns / 2) * y - left) % turns;
      for (int x = left + (shift < 0 ? shift + turns : shift); x < right; x += turns)
        add_still(x, y, levels);
    }
  ++asked_;
}

template <class Places>
void PlaceLevels<Places>::add_still(int x, int y, std::vector<PlaceLevel>& levels) {
  const auto place = places_.at_end(x, y);
  if (!place) return;
  Pixel& pixel = pixels_(x, y);
  if (pixel.events == 0) {
    pixel.track = tracks_++;
    pixel.events = 1;
  } else if (const float moved_x = place->x - pixel.still_x, moved_y = place->y - pixel.still_y;
             static_cast<double>(moved_x * moved_x + moved_y * moved_y) <
             kLeastShare * options_.still_px * options_.still_px) {
    return;
  }
  const Sort sort = pixel.last > 0 ? kSilentUp : pixel.last < 0 ? kSilentDown : kSilent;
  levels.push_back({place->x, place->y, pixel.level, PlaceLevel::tag(pixel.track, sort)});
  pixel.still_x = place->x;
  pixel.still_y = place->y;
}

template class PlaceLevels<SurfacePlaces>;
template class PlaceLevels<DirectionPlaces>;

}  // namespace saccade
