#include "estimator/tracking/intensity/log_intensity_residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade {
namespace {

/// Standard deviation of a reprojection: the map consists of point samples.
constexpr float kPositionSigma_px = 0.2F;

/// Slope of the map [log units/px] at a no-event constraint: flat pixels say nothing.
constexpr float kMinSlope = 0.1F;

/// Events go to random pixels: those of a later one are fetched that many events before.
constexpr std::size_t kPixelsAhead = 16;

/// Pixels without events are updated in so many passes, one with each pose.
constexpr std::size_t kUpdatePasses = 8;

/// Marks an observation whose pixel is not corrected.
constexpr std::uint32_t kNotCorrected = std::numeric_limits<std::uint32_t>::max();

/// Of a no-event constraint, which is uniform within a threshold.
float no_event_variance(const EventContrast& contrast) {
  const double threshold = 0.5 * (contrast.on + contrast.off);
  return static_cast<float>(threshold * threshold / 12);
}

/// 0..1: how much an observation says of the pose where the map varies so much per px^2.
float pose_weight(float variance_per_px2) {
  constexpr auto kSigma = static_cast<float>(LogIntensityResiduals::kSigma);
  constexpr float kFlat = kSigma * kSigma / (kPositionSigma_px * kPositionSigma_px);
  return variance_per_px2 / (kFlat + variance_per_px2);
}

/// 0 where the edges of a picture are those of pixels that average over their area (0.64 measured, on
/// rectangles, photographs and print), 1 where they are those of point samples (0.84 to 0.95).
float sharp_fraction(double edge_sharpness) {
  constexpr double kArea = 0.72, kPoint = 0.84;
  return static_cast<float>(std::clamp((edge_sharpness - kArea) / (kPoint - kArea), 0.0, 1.0));
}

}  // namespace

LogIntensityResiduals::LogIntensityResiduals(const IntensityOptions& options,
                                             const PinholeCamera& camera, const IntensityMap& map)
    : options_(options),
      view_(options, camera, map),
      pixels_(camera.width, camera.height),
      regions_(camera.width, camera.height) {
  set_contrast(ThresholdEstimator::kExpected);
}

void LogIntensityResiduals::begin_learning() {
  thresholds_.emplace(static_cast<std::size_t>(view_.camera().width) *
                      static_cast<std::size_t>(view_.camera().height));
}

void LogIntensityResiduals::end_learning() {
  set_contrast(thresholds_->contrast());
  thresholds_.reset();
}

void LogIntensityResiduals::set_contrast(const EventContrast& contrast) {
  contrast_ = contrast;
  pixels_.set_thresholds(contrast.on, contrast.off);
  no_event_variance_ = no_event_variance(contrast);
  threshold_ = static_cast<float>(0.5 * (contrast.on + contrast.off));
}

void LogIntensityResiduals::reset() {
  intervals_ = {};
  regions_.reset();
  views_drawn_ = 0;
}

void LogIntensityResiduals::restart(const Rigid3& map_from_camera, float sigma) {
  first_steep_pixel_ = 0;
  first_updated_pixel_ = 0;
  draw_view(map_from_camera);
  read_pixels_from_map(sigma);
}

void LogIntensityResiduals::prepare_view(const Rigid3& map_from_camera) {
  if (view_.is_outdated(map_from_camera)) draw_view(map_from_camera);
}

void LogIntensityResiduals::draw_view(const Rigid3& map_from_camera) {
  view_.draw(map_from_camera);
  if (options_.no_event_ratio > 0) steep_pixels_ = view_.steep_pixels(kMinSlope);
  ++views_drawn_;
}

void LogIntensityResiduals::read_pixels_from_map(float sigma) {
  pixels_.reset();
  const PinholeCamera& camera = view_.camera();
  std::size_t pixel = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x, ++pixel)
      if (const auto value = view_.log_intensity(view_.undistorted(x, y)))
        pixels_.set(pixel, *value, sigma * sigma);
}

void LogIntensityResiduals::load(std::span<const Event> events, TimeNs t_ns, double jump_s,
                                 const EventResidualBatch::Motion& motion) {
  batch_count_ = 0;
  loaded_pixels_.clear();
  loaded_regions_.clear();
  bursts_.clear();
  learn_sensor();
  bool has_constraints = !(options_.no_event_ratio > 0);
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    // When the pose is sought, half of the events have happened.
    if (!has_constraints && event.t_ns >= t_ns) {
      const double pixels = 2 * static_cast<double>(bursts_.size());
      load_no_event_constraints(
          static_cast<std::size_t>(std::lround(options_.no_event_ratio * pixels)), motion);
      has_constraints = true;
    }
    const Event& later = events[std::min(i + kPixelsAhead, events.size() - 1)];
    pixels_.prefetch(pixels_.index(later));
    view_.prefetch(view_.undistorted(later.x, later.y));
    add_to_burst(event, static_cast<float>(seconds_from_ns(event.t_ns - t_ns)));
  }
  for (const Burst& burst : bursts_) add_burst(burst, static_cast<float>(jump_s), motion);
}

void LogIntensityResiduals::learn_sensor() {
  // Thresholds of real pixels differ by 15 to 20 % (docs/noise_models.md); those of ideal ones do
  // not, but for what the tolerance of a simulator and a pixel misread at the start add up to.
  constexpr double kReal = 0.15, kIdeal = 0.02;
  const double mismatch =
      options_.mismatch_sigma.value_or(intervals_.has_bursts() ? kIdeal : kReal);
  pixels_.set_event_variance(static_cast<float>(mismatch * mismatch) * threshold_ * threshold_);
  step_weight_ = sharp_fraction(view_.map().edge_sharpness()) * intervals_.pile_up();
}

void LogIntensityResiduals::add_to_burst(const Event& event, float time_s) {
  const std::size_t pixel = pixels_.index(event);
  if (const TimeNs before = pixels_.last_event_ns(pixel); before != PixelLogIntensity::kNoEvent)
    intervals_.add(event.t_ns - before);
  std::uint32_t slot = pixels_.slot(pixel);
  if (slot == PixelLogIntensity::kNoSlot) {
    slot = static_cast<std::uint32_t>(bursts_.size());
    pixels_.set_slot(pixel, slot);
    Burst burst;
    burst.x = event.x;
    burst.y = event.y;
    burst.before = pixels_.between_events(pixel);
    burst.first_s = time_s;
    bursts_.push_back(burst);
    if (thresholds_) thresholds_->begin_level(pixel);
  }
  if (thresholds_) thresholds_->add_event(pixel, event.polarity);
  Burst& burst = bursts_[slot];
  burst.sum += pixels_.add_event(pixel, event.polarity, event.t_ns);
  burst.sum_s += time_s;
  burst.last_s = time_s;
  burst.polarity = event.polarity;
  ++burst.events;
}

void LogIntensityResiduals::add_burst(const Burst& burst, float jump_s,
                                      const EventResidualBatch::Motion& motion) {
  const std::size_t pixel =
      static_cast<std::size_t>(burst.y) * static_cast<std::size_t>(view_.camera().width) + burst.x;
  pixels_.set_slot(pixel, PixelLogIntensity::kNoSlot);
  const auto count = static_cast<float>(burst.events);
  LogIntensityObservation observation;
  observation.pixel = view_.undistorted(burst.x, burst.y);
  observation.time_s = burst.sum_s / count;
  observation.variance = pixels_.variance(pixel);
  // A jump passes all its levels at once: what is known is the middle between what the pixel saw
  // before and what it sees after it.
  const bool is_jump = burst.events > 1 && burst.last_s - burst.first_s < jump_s;
  observation.log_intensity =
      is_jump ? 0.5F * (burst.before + pixels_.between_events(pixel)) : burst.sum / count;
  const MapSample* at = view_.find_sample(observation.pixel, observation.time_s, motion);
  if (at == nullptr) return;
  const bool is_step = observe_step(burst.polarity, pixel, *at, motion, observation);
  if (thresholds_ && (is_step || is_jump)) thresholds_->forget(pixel);
  add(observation, *at, is_step ? kNotCorrected : static_cast<std::uint32_t>(pixel));
}

bool LogIntensityResiduals::observe_step(std::int8_t polarity, std::size_t pixel,
                                         const MapSample& at,
                                         const EventResidualBatch::Motion& motion,
                                         LogIntensityObservation& observation) {
  if (!(step_weight_ > 0)) return false;
  const std::optional<MapLevels> levels = view_.levels(observation, at, motion);
  if (!levels) return false;
  const auto [least, greatest] = *levels;
  const float range = greatest - least;
  // An edge of two thresholds may yield a single event anyway; one of four would yield several.
  constexpr float kSmallest = 2, kCertain = 4;
  const float certainty =
      std::clamp((range / threshold_ - kSmallest) / (kCertain - kSmallest), 0.0F, 1.0F);
  const float weight = step_weight_ * certainty;
  if (!(weight > 0)) return false;  // nor where the map is unknown
  const float middle = 0.5F * (least + greatest);
  observation.log_intensity += weight * (middle - observation.log_intensity);
  // Of a pixel of which nothing is known the variance is infinite.
  observation.variance = weight < 1 ? (1 - weight) * (1 - weight) * observation.variance : 0;
  const float after = polarity > 0 ? greatest : least;
  constexpr float kVariance = 0.25F;  // anything between both is as likely
  pixels_.move(pixel, weight * (after - pixels_.at_last_event(pixel)),
               kVariance * weight * range * range);
  return true;
}

void LogIntensityResiduals::load_no_event_constraints(std::size_t count,
                                                      const EventResidualBatch::Motion& motion) {
  if (count == 0) return;
  // Every n-th of the steep pixels, others each time.
  const std::size_t every = std::max<std::size_t>(1, steep_pixels_.size() / count);
  constexpr std::size_t kNext = 7919;
  first_steep_pixel_ = (first_steep_pixel_ + kNext) % every;
  for (std::size_t i = first_steep_pixel_; i < steep_pixels_.size(); i += every) {
    const std::size_t pixel = steep_pixels_[i];
    const LogIntensityObservation observation = no_event_constraint(pixel);
    const MapSample* at = view_.find_sample(observation.pixel, 0, motion);
    if (at != nullptr &&
        (!pixels_.has_fired(pixel) || is_known_within_threshold(observation, *at, motion)))
      add(observation, *at, kNotCorrected);
  }
}

LogIntensityObservation LogIntensityResiduals::no_event_constraint(std::size_t pixel) const {
  const int x = static_cast<int>(pixel % static_cast<std::size_t>(view_.camera().width));
  const int y = static_cast<int>(pixel / static_cast<std::size_t>(view_.camera().width));
  const float variance = pixels_.variance(pixel);
  // The middle of the interval of a pixel that has not fired since it was read from the map is what it
  // saw then: as a measurement that would hold the camera back. All that is known is that the pixel is
  // within a threshold. Half of one is what holds best: of 84 worlds of one ray per pixel 72 succeed,
  // with 0.3 thresholds 70; with 0.8 the errors of 71 worlds of four rays grow by 4 %.
  constexpr float kDeadZoneThresholds = 0.5F;
  if (!pixels_.has_fired(pixel))
    return {view_.undistorted(x, y), 0, pixels_.at_last_event(pixel), variance,
            kDeadZoneThresholds * threshold_};
  const float value =
      options_.half_threshold ? pixels_.between_events(pixel) : pixels_.at_last_event(pixel);
  return {view_.undistorted(x, y), 0, value, variance + no_event_variance_};
}

bool LogIntensityResiduals::is_known_within_threshold(
    const LogIntensityObservation& observation, const MapSample& at,
    const EventResidualBatch::Motion& motion) const {
  if (intervals_.has_bursts()) return true;
  constexpr float kThresholds = 4;
  const std::optional<MapLevels> levels = view_.levels(observation, at, motion);
  return levels && levels->greatest - levels->least < kThresholds * threshold_;
}

void LogIntensityResiduals::add(LogIntensityObservation observation, const MapSample& at,
                                std::uint32_t pixel) {
  const std::size_t region = regions_.region_of(observation.pixel);
  observation.region_weight = regions_.weight(region);
  loaded_pixels_.push_back(pixel);
  loaded_regions_.push_back(region);
  if (batch_count_ == 0 || batches_[batch_count_ - 1].size() == EventResidualBatch::kCapacity) {
    if (batch_count_ == batches_.size()) batches_.emplace_back();
    batches_[batch_count_++].clear();
  }
  batches_[batch_count_ - 1].add(observation, at);
}

EventResidualBatch::Sums LogIntensityResiduals::evaluate(const EventResidualBatch::Motion& motion) {
  EventResidualBatch::Sums sums;
  for (std::size_t k = 0; k < batch_count_; ++k) {
    batches_[k].evaluate(view_.camera(), view_.map().atlas(), view_.map().variance(), motion);
    batches_[k].weigh({static_cast<float>(kSigma), kPositionSigma_px});
    batches_[k].add_to(sums);
  }
  return sums;
}

void LogIntensityResiduals::learn_regions() {
  std::size_t i = 0;
  for (std::size_t k = 0; k < batch_count_; ++k)
    for (int j = 0; j < batches_[k].size(); ++j)
      regions_.add(loaded_regions_[i++], batches_[k].relative(j), batches_[k].certainty(j));
  regions_.learn();
}

void LogIntensityResiduals::correct(double image_speed_px) {
  learn_regions();
  const double blind_px = blind_s() * image_speed_px;
  const auto blind_px2 = static_cast<float>(std::min(1.0, blind_px * blind_px));
  for_each_measured_pixel(
      [&](std::size_t pixel, float excess, const EventResidualBatch& batch, int j) {
        if (thresholds_)
          thresholds_->measure(pixel, batch.log_intensity(j) - excess,
                               pose_weight(batch.variance_per_px2(j)));
        // What does not fit may be something that the map does not hold.
        pixels_.correct(pixel, excess, (1 + batch.relative(j)) * batch.map_variance(j));
        pixels_.move(pixel, 0, blind_px2 * batch.variance_per_px2(j));
      });
}

void LogIntensityResiduals::update_pixels_without_events(const EventResidualBatch::Motion& motion) {
  // Of the half threshold on either side of where a pixel most likely is it knows the variance, and
  // that as much again is possible.
  constexpr float kVariances = 2;
  const float noise = kVariances * no_event_variance_;
  batch_count_ = 0;
  loaded_pixels_.clear();
  loaded_regions_.clear();
  first_updated_pixel_ = (first_updated_pixel_ + 1) % kUpdatePasses;
  const std::size_t count = static_cast<std::size_t>(view_.camera().width) *
                            static_cast<std::size_t>(view_.camera().height);
  for (std::size_t i = first_updated_pixel_; i < count; i += kUpdatePasses) {
    if (!(pixels_.variance(i) > noise)) continue;
    const int x = static_cast<int>(i % static_cast<std::size_t>(view_.camera().width));
    const int y = static_cast<int>(i / static_cast<std::size_t>(view_.camera().width));
    const LogIntensityObservation observation{view_.undistorted(x, y), 0, pixels_.between_events(i),
                                              pixels_.variance(i)};
    if (const MapSample* at = view_.find_sample(observation.pixel, 0, motion))
      add(observation, *at, static_cast<std::uint32_t>(i));
  }
  static_cast<void>(evaluate(motion));
  for_each_measured_pixel(
      [&](std::size_t pixel, float excess, const EventResidualBatch& batch, int j) {
        pixels_.correct(pixel, excess, noise + batch.map_variance(j));
      });
}

template <class Use>
void LogIntensityResiduals::for_each_measured_pixel(const Use& use) {
  std::size_t i = 0;
  for (std::size_t k = 0; k < batch_count_; ++k)
    for (int j = 0; j < batches_[k].size(); ++j, ++i) {
      const float excess = batches_[k].residual(j);
      if (loaded_pixels_[i] != kNotCorrected && std::isfinite(excess))
        use(loaded_pixels_[i], excess, batches_[k], j);
    }
}

}  // namespace saccade
