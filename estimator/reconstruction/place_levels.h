#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/place_finder.h"
#include "estimator/reconstruction/pose_table.h"

namespace saccade {

/// What distinguishes the few sorts of levels.
struct LevelSort {
  float deviation;  ///< of the level [log units]
  float slack;      ///< 0 at an event; else the pixel was silent and the level is within +- this
  float beyond;     ///< where between -slack and slack it is likely
};

/// What a sensor pixel says about the reference image when it looks at one of its places: the log
/// intensity there is `level` above an offset that is the same along the pixel's track. In little
/// memory, as there are several per event.
struct PlaceLevel {
  float x, y;   ///< [px of the reference view], within it
  float level;  ///< [log units]
  std::uint32_t track_and_sort;

  static constexpr std::uint32_t kSortBits = 3;
  static constexpr std::uint32_t tag(std::uint32_t track, std::uint32_t sort) {
    return track << kSortBits | sort;
  }
  /// Counts from 0.
  [[nodiscard]] std::uint32_t track() const { return track_and_sort >> kSortBits; }
  /// Index into LevelFinder::sorts().
  [[nodiscard]] std::uint32_t sort() const { return track_and_sort & ((1U << kSortBits) - 1); }
};

struct LevelOptions {
  double event_sigma = 0.03;   ///< deviation of an event's step, beside what its place is off [log]
  bool still = true;           ///< pixels that moved and had no event say so
  int track_events = 1000000;  ///< after which a pixel's offset is taken to have drifted away
  double still_px = 3;         ///< ... they are asked each time the image has moved this far
  int still_turns = 1;         ///< ... every n-th pixel at a time, each in its turn
  double still_events = 1e9;   ///< ... more seldom where there are more events per pixel than this
  double beyond =
      0.5;  ///< ... and where they are likely: this share of a threshold beyond the last event
  PlaceOptions places;
};

/// Turns events into levels of the reference image. At the instant of an event the level is exact:
/// the sum of all p C of the pixel so far. Places are visible where the reference view sees nothing
/// nearer (z-test) and are within it. All pixels are followed from one time to the next, over which
/// the image moves by less than a pixel, nearly straight; in between places are interpolated.
class LevelFinder {
 public:
  /// `reference_inverse_depth`: what the reference view sees. All arguments outlive the finder.
  LevelFinder(const PinholeCamera& camera, const DepthScene& scene,
              const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
              double contrast_on, double contrast_off, const LevelOptions& options);

  /// Tracks so far.
  [[nodiscard]] std::uint32_t tracks() const { return tracks_; }

  [[nodiscard]] std::span<const LevelSort> sorts() const { return sorts_; }

  /// Where many of `events` are to come, silent pixels will be asked seldom (still_events).
  void expect(std::span<const Event> events);

  /// Appends what `events` say (in order of time, and not before those of an earlier call).
  void find(std::span<const Event> events, const Trajectory& world_from_camera,
            std::vector<PlaceLevel>& levels);

 private:
  /// Indices of sorts_.
  enum Sort : std::uint32_t { kEvent, kJumpUp, kJumpDown, kSilent, kSilentUp, kSilentDown, kSorts };

  struct Pixel {
    float level = 0;          ///< sum of its events
    float inverse_depth = 0;  ///< of the last visible place in the reference view; 0: none so far
    float x = 0, y = 0;       ///< of that place, at its last event
    float still_x = 0, still_y = 0;  ///< where it last said anything
    TimeNs t_ns = 0;                 ///< of the last event
    std::uint32_t track = 0;
    int events = 0;  ///< of its track
    int last = 0;    ///< polarity of the last event, 0: none so far
  };

  /// All pixels at one time.
  struct Moment {
    TimeNs t_ns = 0;
    CameraPose reference_from_camera;
    PlaceField places;
  };

  [[nodiscard]] CameraPose pose_at(const Trajectory& world_from_camera, TimeNs t_ns) const;
  void start(const Trajectory& world_from_camera, TimeNs t_ns);
  /// From begin_ to end_, at most until `last_ns`.
  void advance(const Trajectory& world_from_camera, TimeNs last_ns);
  [[nodiscard]] std::optional<Place> place_of(const Event& event) const;
  void add_event(const Event& event, const Place& place, std::vector<PlaceLevel>& levels);
  void ask_still(std::vector<PlaceLevel>& levels);
  void add_still(std::size_t pixel, std::vector<PlaceLevel>& levels);

  PlaceFinder places_;
  Rigid3 reference_from_world_;
  float contrast_on_, contrast_off_;
  LevelOptions options_;
  std::array<LevelSort, kSorts> sorts_;
  Image<Pixel> pixels_;
  Image<int> turns_;                 ///< of silent pixels, by tile of the sensor
  Moment begin_, end_;               ///< around the events that are at hand
  TimeNs length_ns_ = 1'000'000;     ///< from one to the other, as it was last
  CameraPose asked_from_reference_;  ///< the camera when silent pixels were asked last
  int asked_ = 0;                    ///< how often they were
  std::uint32_t tracks_ = 0;
};

}  // namespace saccade
