#pragma once

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

/// What a sensor pixel says about the reference image when it looks at one of its places: the log
/// intensity there is `level` above an offset that is the same along the pixel's track.
struct PlaceLevel {
  std::uint32_t track;  ///< counts from 0
  float x, y;           ///< [px of the reference view], within it
  float level;          ///< [log units]
  float deviation;      ///< of `level` [log units]
  float slack;   ///< 0 at an event; else the pixel was silent and the level is within +- this
  float beyond;  ///< where between -slack and slack it is likely
};

struct LevelOptions {
  double event_sigma = 0.03;   ///< deviation of an event's step, beside what its place is off [log]
  bool still = true;           ///< pixels that moved and had no event say so
  int track_events = 1000000;  ///< after which a pixel's offset is taken to have drifted away
  double still_px = 3;         ///< ... they are asked each time the image has moved this far
  int still_turns = 1;         ///< ... every n-th pixel at a time, each in its turn
  double beyond =
      0.5;  ///< ... and where they are likely: this share of a threshold beyond the last event
  PlaceOptions places;
};

/// Turns events into levels of the reference image. At the instant of an event the level is exact:
/// the sum of all p C of the pixel so far. Places are visible where the reference
/// view sees nothing nearer (z-test) and are within it.
class LevelFinder {
 public:
  /// `reference_inverse_depth`: what the reference view sees. All arguments outlive the finder.
  LevelFinder(const PinholeCamera& camera, const DepthScene& scene,
              const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
              double contrast_on, double contrast_off, const LevelOptions& options);

  /// Tracks so far.
  [[nodiscard]] std::uint32_t tracks() const { return tracks_; }

  /// Appends what `events` say (in order of time).
  void find(std::span<const Event> events, const Trajectory& world_from_camera,
            std::vector<PlaceLevel>& levels);

 private:
  struct Pixel {
    float level = 0;          ///< sum of its events
    float inverse_depth = 0;  ///< of the last visible place in the reference view; 0: none so far
    float x = 0, y = 0;       ///< of that place, at its last event
    float still_x = 0, still_y = 0;  ///< where it last said anything
    TimeNs t_ns = 0;                 ///< of the last event
    std::uint32_t track = 0;
    int events = 0;  ///< of its track
    float last = 0;  ///< polarity of the last event, 0: none so far
  };

  [[nodiscard]] std::optional<Place> find_place(int x, int y, const CameraPose& pose) const;
  void add_event(const Event& event, const CameraPose& pose, std::vector<PlaceLevel>& levels);
  void ask_still(const CameraPose& pose, std::vector<PlaceLevel>& levels);
  void add_still(int x, int y, const CameraPose& pose, std::vector<PlaceLevel>& levels);

  PlaceFinder places_;
  Rigid3 world_from_reference_;
  float contrast_on_, contrast_off_;
  LevelOptions options_;
  Image<Pixel> pixels_;
  CameraPose asked_from_reference_;  ///< the camera when silent pixels were asked last
  int asked_ = 0;                    ///< how often they were
  std::uint32_t tracks_ = 0;
};

}  // namespace saccade
