#include "estimator/reconstruction/place_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saccade {
namespace {

constexpr int kTile = 16;  ///< in which silent pixels take equal turns [px]

constexpr TimeNs kAtOnceNs = 2000;

/// Of the square of the furthest motion: a silent pixel that has moved less has nothing to add.
constexpr double kLeastShare = 0.25;

constexpr double kLongest_px = 2;  ///< between two moments at which all places are found
constexpr double kMostBend_px = 0.05;
constexpr TimeNs kShortestNs = 50'000;
constexpr TimeNs kLongestNs = 20'000'000;

}  // namespace

LevelFinder::LevelFinder(const PinholeCamera& camera, const DepthScene& scene,
                         const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                         double contrast_on, double contrast_off, const LevelOptions& options)
    : places_(camera, scene, world_from_reference, reference_inverse_depth, options.places),
      reference_from_world_(world_from_reference.inverse()),
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
  begin_.places.resize(pixels_.size());
  end_.places.resize(pixels_.size());
}

void LevelFinder::expect(std::span<const Event> events) {
  Image<int> counts(turns_.width(), turns_.height());
  for (const Event& event : events) ++counts(event.x / kTile, event.y / kTile);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double share = counts.pixels()[i] / (options_.still_events * kTile * kTile);
    turns_.pixels()[i] = static_cast<int>(options_.still_turns * std::max(share, 1.0));
  }
}

void LevelFinder::find(std::span<const Event> events, const Trajectory& world_from_camera,
                       std::vector<PlaceLevel>& levels) {
  if (events.empty()) return;
  if (asked_ == 0) {
    start(world_from_camera, events.front().t_ns);
    ask_still(levels);
  }
  const TimeNs last_ns = events.back().t_ns;
  for (std::size_t i = 0; i < events.size();) {
    advance(world_from_camera, last_ns);
    for (; i < events.size() && events[i].t_ns <= end_.t_ns; ++i) {
      pixels_(events[i].x, events[i].y).level +=
          events[i].polarity > 0 ? contrast_on_ : -contrast_off_;
      if (const auto place = place_of(events[i])) add_event(events[i], *place, levels);
    }
    if (options_.still && places_.moved_px(end_.reference_from_camera, asked_from_reference_) >=
                              0.9 * options_.still_px)
      ask_still(levels);
  }
}

CameraPose LevelFinder::pose_at(const Trajectory& world_from_camera, TimeNs t_ns) const {
  const Rigid3 pose = reference_from_world_ * world_from_camera.at_clamped(seconds_from_ns(t_ns));
  return {pose.rotation_matrix().cast<float>(), pose.translation().cast<float>()};
}

void LevelFinder::start(const Trajectory& world_from_camera, TimeNs t_ns) {
  end_.t_ns = t_ns;
  end_.reference_from_camera = pose_at(world_from_camera, t_ns);
  places_.prepare(end_.reference_from_camera);
  std::fill(begin_.places.inverse_depth.begin(), begin_.places.inverse_depth.end(), 0.0F);
  places_.follow(end_.reference_from_camera, begin_.places, end_.places);
}

void LevelFinder::advance(const Trajectory& world_from_camera, TimeNs last_ns) {
  std::swap(begin_, end_);
  const double longest_px = std::min(kLongest_px, options_.still_px);
  CameraPose& pose = end_.reference_from_camera;
  for (;;) {
    length_ns_ = std::clamp(length_ns_, kShortestNs, kLongestNs);
    end_.t_ns = std::max(begin_.t_ns + 1, std::min(begin_.t_ns + length_ns_, last_ns));
    pose = pose_at(world_from_camera, end_.t_ns);
    const CameraPose middle =
        pose_at(world_from_camera, begin_.t_ns + (end_.t_ns - begin_.t_ns) / 2);
    const ViewShift motion =
        places_.motion(begin_.reference_from_camera, inverse_of(middle), inverse_of(pose));
    const double share =
        std::max(motion.length / longest_px, std::sqrt(motion.bend / kMostBend_px));
    const auto length = static_cast<double>(end_.t_ns - begin_.t_ns);
    length_ns_ = static_cast<TimeNs>(length * std::clamp(0.95 / share, 0.25, 2.0));
    if (share <= 1 || end_.t_ns - begin_.t_ns <= kShortestNs) break;
  }
  places_.prepare(pose);
  places_.follow(pose, begin_.places, end_.places);
}

std::optional<Place> LevelFinder::place_of(const Event& event) const {
  const auto i =
      static_cast<std::size_t>(event.y) * static_cast<std::size_t>(pixels_.width()) + event.x;
  const float share =
      static_cast<float>(event.t_ns - begin_.t_ns) / static_cast<float>(end_.t_ns - begin_.t_ns);
  const PlaceField& a = begin_.places;
  const PlaceField& b = end_.places;
  const auto same = static_cast<float>(options_.places.same_surface);
  if (a.inverse_depth[i] > 0 && b.inverse_depth[i] > 0 &&
      std::abs(a.inverse_depth[i] - b.inverse_depth[i]) <= same * a.inverse_depth[i])
    return Place{a.x[i] + share * (b.x[i] - a.x[i]), a.y[i] + share * (b.y[i] - a.y[i]),
                 a.inverse_depth[i] + share * (b.inverse_depth[i] - a.inverse_depth[i])};
  const CameraPose& from = begin_.reference_from_camera;
  const CameraPose& to = end_.reference_from_camera;
  return places_.find(event.x, event.y,
                      {from.r + share * (to.r - from.r), from.t + share * (to.t - from.t)});
}

void LevelFinder::add_event(const Event& event, const Place& place,
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

void LevelFinder::ask_still(std::vector<PlaceLevel>& levels) {
  asked_from_reference_ = inverse_of(end_.reference_from_camera);
  // Neighbours in both directions have different turns, so that no place is left out.
  const int width = pixels_.width();
  for (int y = 0; y < pixels_.height() && options_.still; ++y)
    for (int left = 0; left < width; left += kTile) {
      const int turns = turns_(left / kTile, y / kTile);
      const int right = std::min(left + kTile, width);
      const int shift = (asked_ + (turns / 2) * y - left) % turns;
      for (int x = left + (shift < 0 ? shift + turns : shift); x < right; x += turns)
        add_still(static_cast<std::size_t>(y * width + x), levels);
    }
  ++asked_;
}

void LevelFinder::add_still(std::size_t i, std::vector<PlaceLevel>& levels) {
  if (!(end_.places.inverse_depth[i] > 0)) return;
  const float x = end_.places.x[i], y = end_.places.y[i];
  Pixel& pixel = pixels_.pixels()[i];
  if (pixel.events == 0) {
    pixel.track = tracks_++;
    pixel.events = 1;
  } else if (const float moved_x = x - pixel.still_x, moved_y = y - pixel.still_y;
             static_cast<double>(moved_x * moved_x + moved_y * moved_y) <
             kLeastShare * options_.still_px * options_.still_px) {
    return;
  }
  const Sort sort = pixel.last > 0 ? kSilentUp : pixel.last < 0 ? kSilentDown : kSilent;
  levels.push_back({x, y, pixel.level, PlaceLevel::tag(pixel.track, sort)});
  pixel.still_x = x;
  pixel.still_y = y;
}

}  // namespace saccade
