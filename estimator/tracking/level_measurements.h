#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/tracking/event_chunk.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/intensity_options.h"
#include "estimator/tracking/map_view.h"
#include "estimator/tracking/pixel_levels.h"

namespace saccade {

/// What the pixels of an event camera say about a pose before a known map: at each event the level
/// that its pixel has reached, and beside them the levels of pixels between their events, which are
/// known to within a threshold C: level + p C/2 with p the polarity of the last event, and by the
/// uniform deviation C / sqrt(12) around it less trusted. Holds the levels and the view of the map.
class LevelMeasurements {
 public:
  /// `camera` may be distorted; `map` outlives this.
  LevelMeasurements(const IntensityOptions& options, const EventContrast& contrast,
                    const PinholeCamera& camera, const IntensityMap& map);

  /// Forgets all levels and reads them from the map at a pose; they are trusted as after `looks`
  /// corrections.
  void restart(const Rigid3& map_from_camera, float looks);

  /// Draws the map anew if the view has moved too far since it was drawn.
  void prepare_view(const Rigid3& map_from_camera);

  /// Takes a batch of events in, in order of time. `t_ns` is the time of the pose that is sought,
  /// `motion` the expected one.
  void load(std::span<const Event> events, TimeNs t_ns, const EventChunk::Motion& motion);

  /// Residuals and their normal equations at a pose, over all that was loaded.
  [[nodiscard]] EventChunk::Sums evaluate(const EventChunk::Motion& motion);

  /// Draws the levels of the loaded events towards the map at the pose of the last evaluate().
  void correct();

  [[nodiscard]] double typical_depth_m() const { return view_.typical_depth_m(); }
  [[nodiscard]] std::size_t views_drawn() const { return views_drawn_; }
  void count_views_anew() { views_drawn_ = 0; }

 private:
  void draw_view(const Rigid3& map_from_camera);
  void list_steep_pixels();
  void start_levels(float looks);
  /// Some `count` pixels between their events, at the time of the pose.
  void load_pixels(std::size_t count, const EventChunk::Motion& motion);
  /// `pixel`: whose level correct() will draw to the map.
  void add(const EventMeasurement& measurement, const SeenPlace& seen, std::uint32_t pixel);
  void prefetch(const Event& event, bool is_aligned) const;
  [[nodiscard]] bool find_place(const Eigen::Vector2f& pixel, float time_s,
                                const EventChunk::Motion& motion, SeenPlace& seen) const;

  IntensityOptions options_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
  const IntensityMap& map_;
  MapView view_;
  PixelLevels levels_;
  float between_trust_;  ///< in a pixel between its events
  std::vector<EventChunk> chunks_;
  std::size_t chunk_count_ = 0;
  std::vector<std::uint32_t> loaded_pixels_;  ///< of all in the chunks, in order
  std::vector<std::uint32_t> steep_pixels_;  ///< where the map is steep, in the view that was drawn
  std::size_t first_pixel_ = 0;              ///< of them that was loaded
  std::size_t views_drawn_ = 0;
};

}  // namespace saccade
