#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/tracking/intensity/event_intervals.h"
#include "estimator/tracking/intensity/event_residual_batch.h"
#include "estimator/tracking/intensity/intensity_options.h"
#include "estimator/tracking/intensity/map_reprojection.h"
#include "estimator/tracking/intensity/pixel_log_intensity.h"
#include "estimator/tracking/intensity/region_weights.h"
#include "estimator/tracking/intensity/threshold_estimator.h"
#include "estimator/tracking/intensity_map.h"

namespace saccade {

/// The residuals of the intensity tracker. Observations of two kinds say what log intensity a pixel
/// sees: its events of a batch, at their mean time, and beside them no-event constraints of pixels
/// between their events, which are known to within a threshold C: l + p C/2 with p the polarity of
/// the last event, with the uniform standard deviation C / sqrt(12) around it.
///
/// An event says less where an edge passes too fast. Several events of a pixel at once say only that
/// it jumped from one level to another, and that the middle between both is there. Where pixels are
/// blind for a while after an event (EventIntervals) a single event may be all that a jump leaves:
/// then the map tells both levels. Holds the pixels' state and what they see of the map.
class LogIntensityResiduals {
 public:
  /// sigma of an observation [log units]: texture between the map's point samples, noise.
  static constexpr double kSigma = 0.05;

  /// `camera` may be distorted; `map` outlives this.
  LogIntensityResiduals(const IntensityOptions& options, const PinholeCamera& camera,
                        const IntensityMap& map);

  /// Forgets what the events told of the sensor.
  void reset();

  /// Reads all pixels from the map at a pose, with this standard deviation.
  void restart(const Rigid3& map_from_camera, float sigma);

  /// Renders the map anew if the view has moved too far since.
  void prepare_view(const Rigid3& map_from_camera);

  /// Takes a batch of events in, in order of time. `t_ns` is the time of the pose that is sought,
  /// `motion` the expected one; events of a pixel within `jump_s` are a jump.
  void load(std::span<const Event> events, TimeNs t_ns, double jump_s,
            const EventResidualBatch::Motion& motion);

  /// Residuals and their normal equations at a pose, over all that was loaded.
  [[nodiscard]] EventResidualBatch::Sums evaluate(const EventResidualBatch::Motion& motion);

  /// Corrects the pixels of the loaded events towards the map at the pose of the last evaluate(),
  /// each by what it is less certain than the map, and learns how much each region counts. After an
  /// event a pixel misses what happens while it is blind and the image moves at `image_speed_px` per
  /// second.
  void correct(double image_speed_px);

  /// Pixels of which little is known are read from the map at a pose: between its events a pixel is
  /// within a threshold of its last value.
  void update_pixels_without_events(const EventResidualBatch::Motion& motion);

  /// Those in use.
  [[nodiscard]] const EventContrast& contrast() const { return contrast_; }
  void set_contrast(const EventContrast& contrast);
  /// correct() also learns thresholds from the poses that evaluate() was given, until ...
  void begin_learning();
  /// ... here, where they are taken over.
  void end_learning();

  [[nodiscard]] double typical_depth_m() const { return view_.typical_depth_m(); }
  [[nodiscard]] std::size_t views_drawn() const { return views_drawn_; }

 private:
  void draw_view(const Rigid3& map_from_camera);
  void read_pixels_from_map(float sigma);
  /// The events of one pixel in a batch: one observation.
  struct Burst {
    std::uint16_t x = 0, y = 0;
    int events = 0;
    std::int8_t polarity = 0;  ///< of the last
    float before = 0;          ///< what it saw before, most likely
    float sum = 0;             ///< of the log intensities at its events
    float sum_s = 0, first_s = 0, last_s = 0;
  };
  void add_to_burst(const Event& event, float time_s);
  void add_burst(const Burst& burst, float jump_s, const EventResidualBatch::Motion& motion);
  /// Makes an observation that of a step of the map's, by so much as a single event may be one, and
  /// the pixel's value what it is behind it. False where it is none.
  [[nodiscard]] bool observe_step(std::int8_t polarity, std::size_t pixel, const MapSample& at,
                                  const EventResidualBatch::Motion& motion,
                                  LogIntensityObservation& observation);
  /// What a pixel without an event sees, at the time of the pose.
  [[nodiscard]] LogIntensityObservation no_event_constraint(std::size_t pixel) const;
  /// Whether a pixel that has fired is within a threshold of its value: a blind one may have missed
  /// the edge beside it.
  [[nodiscard]] bool is_known_within_threshold(const LogIntensityObservation& observation,
                                               const MapSample& at,
                                               const EventResidualBatch::Motion& motion) const;
  /// Of the sensor, from its events so far.
  void learn_sensor();
  /// For so long a pixel is blind after an event [s]; 0 where that hides little.
  [[nodiscard]] double blind_s() const {
    return intervals_.pile_up() > 0 ? intervals_.shortest_s() : 0;
  }
  /// Calls use(pixel, residual, batch, index in it) for all loaded pixels that are to be corrected.
  template <class Use>
  void for_each_measured_pixel(const Use& use);
  /// Some `count` no-event constraints, at the time of the pose.
  void load_no_event_constraints(std::size_t count, const EventResidualBatch::Motion& motion);
  /// `pixel`: the one that correct() will correct.
  void add(LogIntensityObservation observation, const MapSample& at, std::uint32_t pixel);
  void learn_regions();

  IntensityOptions options_;
  MapReprojection view_;
  EventContrast contrast_;
  std::optional<ThresholdEstimator> thresholds_;  ///< while they are learned
  PixelLogIntensity pixels_;
  /// Kept after a loss, and from the learning of thresholds on: what moves is still there.
  RegionWeights regions_;
  float no_event_variance_;
  float threshold_;  ///< mean of ON and OFF
  EventIntervals intervals_;
  float step_weight_ = 0;  ///< 0..1: how much single events may be steps
  std::vector<Burst> bursts_;
  std::vector<EventResidualBatch> batches_;
  std::size_t batch_count_ = 0;
  std::vector<std::uint32_t> loaded_pixels_;  ///< of all in the batches, in order
  std::vector<std::size_t> loaded_regions_;   ///< of the same
  std::vector<std::uint32_t> steep_pixels_;   ///< where the rendered map is steep
  std::size_t first_steep_pixel_ = 0;         ///< of them that was loaded
  std::size_t first_updated_pixel_ = 0;
  std::size_t views_drawn_ = 0;
};

}  // namespace saccade
