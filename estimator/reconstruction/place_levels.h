#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/direction_places.h"
#include "estimator/reconstruction/surface_places.h"

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
  float x, y;   ///< [px of the reference view], within it; see ReferenceGrid::at()
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
/// the sum of all p C of the pixel so far.
class LevelFinder {
 public:
  virtual ~LevelFinder() = default;

  [[nodiscard]] virtual std::span<const LevelSort> sorts() const = 0;

  /// Where many of `events` are to come, silent pixels will be asked seldom (still_events).
  virtual void expect(std::span<const Event> events) = 0;

  /// Appends what `events` say (in order of time, and not before those of an earlier call).
  virtual void find(std::span<const Event> events, const Trajectory& world_from_camera,
                    std::vector<PlaceLevel>& levels) = 0;

  /// What all events say, handed to `use` part by part, with the share of the events that this and
  /// the parts before it are from. Returns the seconds that finding it took.
  double find_all(
      std::span<const Event> events, const Trajectory& world_from_camera,
      const std::function<void(std::span<const PlaceLevel>, double share_of_events)>& use);
};

/// Where pixels look is what `Places` says, from one time to the next: SurfacePlaces or
/// DirectionPlaces.
template <class Places>
class PlaceLevels : public LevelFinder {
 public:
  PlaceLevels(Places places, const PinholeCamera& camera, double contrast_on, double contrast_off,
              const LevelOptions& options);

  [[nodiscard]] std::span<const LevelSort> sorts() const override { return sorts_; }
  void expect(std::span<const Event> events) override;
  void find(std::span<const Event> events, const Trajectory& world_from_camera,
            std::vector<PlaceLevel>& levels) override;

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

  void add_event(const Event& event, const Place& place, std::vector<PlaceLevel>& levels);
  void ask_still(std::vector<PlaceLevel>& levels);
  void add_still(int x, int y, std::vector<PlaceLevel>& levels);

  Places places_;
  float contrast_on_, contrast_off_;
  LevelOptions options_;
  std::array<LevelSort, kSorts> sorts_;
  Image<Pixel> pixels_;
  Image<int> turns_;                 ///< of silent pixels, by tile of the sensor
  CameraPose asked_from_reference_;  ///< the camera when silent pixels were asked last
  int asked_ = 0;                    ///< how often they were
  std::uint32_t tracks_ = 0;
};

/// Levels of a view whose depth is known.
class SurfaceLevels : public PlaceLevels<SurfacePlaces> {
 public:
  /// `reference_inverse_depth`: what the reference view sees. All but the options outlive the
  /// finder.
  SurfaceLevels(const PinholeCamera& camera, const DepthScene& scene,
                const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                double contrast_on, double contrast_off, const LevelOptions& options)
      : PlaceLevels(SurfacePlaces(camera, scene, world_from_reference, reference_inverse_depth,
                                  options.places, options.still_px),
                    camera, contrast_on, contrast_off, options) {}
};

/// Levels of a panorama, whose world is the reference view.
class DirectionLevels : public PlaceLevels<DirectionPlaces> {
 public:
  DirectionLevels(const PinholeCamera& camera, const Panorama& panorama, double contrast_on,
                  double contrast_off, const LevelOptions& options)
      : PlaceLevels(DirectionPlaces(camera, panorama), camera, contrast_on, contrast_off, options) {
  }
};

}  // namespace saccade
