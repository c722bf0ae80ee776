#include "estimator/tracking/intensity/log_intensity_residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace saccade {
namespace {

/// Beyond the image the view reaches this much further than it may move before it is redrawn.
constexpr int kSpareNodes = 4;

/// Standard deviation of a reprojection: the map consists of point samples.
constexpr float kPositionSigma_px = 0.2F;

/// Slope of the map [log units/px] at a no-event constraint: flat pixels say nothing.
constexpr float kMinSlope = 0.1F;

/// Events go to random pixels: those of a later one are fetched that many events before.
constexpr std::size_t kPixelsAhead = 16;

/// Marks an observation whose pixel is not corrected.
constexpr std::uint32_t kNotCorrected = std::numeric_limits<std::uint32_t>::max();

/// A view of some 240 columns is fine enough: what lies between its nodes is extrapolated.
int spacing_of(const PinholeCamera& camera) {
  constexpr double kColumns = 240;
  return std::max(1, static_cast<int>(std::lround(camera.width / kColumns)));
}

double redraw_px(const IntensityOptions& options, const PinholeCamera& camera) {
  return camera.fx * options.redraw_deg * std::numbers::pi / 180;
}

int margin_of(const IntensityOptions& options, const PinholeCamera& camera) {
  return static_cast<int>(std::ceil(redraw_px(options, camera) / spacing_of(camera))) + kSpareNodes;
}

/// sigma^2 of an event over that of a no-event constraint, which is uniform within a threshold.
float no_event_weight(const EventContrast& contrast) {
  constexpr double kVariance = LogIntensityResiduals::kSigma * LogIntensityResiduals::kSigma;
  const double threshold = 0.5 * (contrast.on + contrast.off);
  return static_cast<float>(kVariance / (kVariance + threshold * threshold / 12));
}

}  // namespace

LogIntensityResiduals::LogIntensityResiduals(const IntensityOptions& options,
                                             const EventContrast& contrast,
                                             const PinholeCamera& camera, const IntensityMap& map)
    : options_(options),
      camera_(camera.undistorted()),
      undistortion_(camera),
      map_(map),
      view_(map, margin_of(options, camera), spacing_of(camera)),
      pixels_(camera.width, camera.height, contrast.on, contrast.off, options.correction_fraction),
      no_event_weight_(no_event_weight(contrast)) {}

void LogIntensityResiduals::restart(const Rigid3& map_from_camera, float corrections) {
  first_steep_pixel_ = 0;
  draw_view(map_from_camera);
  read_pixels_from_map(corrections);
}

void LogIntensityResiduals::prepare_view(const Rigid3& map_from_camera) {
  if (view_.moved_px(map_from_camera) >= redraw_px(options_, camera_)) draw_view(map_from_camera);
}

void LogIntensityResiduals::draw_view(const Rigid3& map_from_camera) {
  view_.draw(map_from_camera);
  list_steep_pixels();
  ++views_drawn_;
}

void LogIntensityResiduals::read_pixels_from_map(float corrections) {
  pixels_.reset();
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x) {
      const Eigen::Vector2f pixel = undistortion_(x, y);
      const MapSample* at = sample_at(pixel);
      if (at == nullptr) continue;
      const Eigen::Vector2i node = view_.node_at(pixel);
      const Eigen::Vector2f offset = pixel - (view_.spacing_px() * node).cast<float>();
      const Eigen::Vector2f atlas_px = at->atlas_px + at->atlas_per_pixel * offset;
      if (!is_inside(map_.atlas(), atlas_px.x(), atlas_px.y())) continue;
      const float value = sample(map_.atlas(), atlas_px.x(), atlas_px.y());
      if (!std::isfinite(value)) continue;
      pixels_.set(static_cast<std::size_t>(y * camera_.width + x), value, corrections);
    }
}

void LogIntensityResiduals::load(std::span<const Event> events, TimeNs t_ns,
                                 const EventResidualBatch::Motion& motion) {
  batch_count_ = 0;
  loaded_pixels_.clear();
  const auto samples = static_cast<std::size_t>(options_.samples);
  // One in `every` events is aligned, the others only count for their pixels.
  const std::size_t every = (events.size() + samples - 1) / samples;
  const auto constraints = static_cast<std::size_t>(std::lround(
      options_.no_event_ratio * static_cast<double>(events.size()) / static_cast<double>(every)));
  bool has_constraints = constraints == 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    // When the pose is sought, half of the events have happened.
    if (!has_constraints && event.t_ns >= t_ns) {
      load_no_event_constraints(constraints, motion);
      has_constraints = true;
    }
    const std::size_t ahead = std::min(i + kPixelsAhead, events.size() - 1);
    prefetch(events[ahead], ahead % every == 0);
    const std::size_t pixel = pixels_.index(event);
    LogIntensityObservation observation;
    observation.log_intensity = pixels_.add_event(pixel, event.polarity);
    if (i % every != 0) continue;
    observation.pixel = undistortion_(event.x, event.y);
    observation.time_s = static_cast<float>(seconds_from_ns(event.t_ns - t_ns));
    observation.confidence = pixels_.confidence(pixel);
    if (const MapSample* at = find_sample(observation.pixel, observation.time_s, motion))
      add(observation, *at, static_cast<std::uint32_t>(pixel));
  }
}

void LogIntensityResiduals::load_no_event_constraints(std::size_t count,
                                                      const EventResidualBatch::Motion& motion) {
  // Every n-th of the steep pixels, others each time.
  const std::size_t every = std::max<std::size_t>(1, steep_pixels_.size() / count);
  constexpr std::size_t kNext = 7919;
  first_steep_pixel_ = (first_steep_pixel_ + kNext) % every;
  for (std::size_t i = first_steep_pixel_; i < steep_pixels_.size(); i += every) {
    const std::size_t pixel = steep_pixels_[i];
    const int x = static_cast<int>(pixel % static_cast<std::size_t>(camera_.width));
    const int y = static_cast<int>(pixel / static_cast<std::size_t>(camera_.width));
    LogIntensityObservation observation;
    observation.log_intensity =
        options_.half_threshold ? pixels_.between_events(pixel) : pixels_.at_last_event(pixel);
    observation.pixel = undistortion_(x, y);
    observation.time_s = 0;
    observation.confidence = no_event_weight_ * pixels_.confidence(pixel);
    if (const MapSample* at = find_sample(observation.pixel, 0, motion))
      add(observation, *at, kNotCorrected);
  }
}

void LogIntensityResiduals::list_steep_pixels() {
  steep_pixels_.clear();
  if (!(options_.no_event_ratio > 0)) return;
  const ImageF& atlas = map_.atlas();
  const int spacing = view_.spacing_px();
  for (int y = 0; y < camera_.height; y += spacing)
    for (int x = 0; x < camera_.width; x += spacing) {
      const MapSample* at = sample_at(undistortion_(x, y));
      if (at == nullptr) continue;
      const int u = static_cast<int>(at->atlas_px.x());
      const int v = static_cast<int>(at->atlas_px.y());
      if (u < 0 || v < 0 || u + 1 >= atlas.width() || v + 1 >= atlas.height()) continue;
      const Eigen::Vector2f slope(atlas(u + 1, v) - atlas(u, v), atlas(u, v + 1) - atlas(u, v));
      // Not so where it is unknown.
      if ((at->atlas_per_pixel.transpose() * slope).squaredNorm() >= kMinSlope * kMinSlope)
        steep_pixels_.push_back(static_cast<std::uint32_t>(y * camera_.width + x));
    }
}

void LogIntensityResiduals::add(const LogIntensityObservation& observation, const MapSample& at,
                                std::uint32_t pixel) {
  loaded_pixels_.push_back(pixel);
  if (batch_count_ == 0 || batches_[batch_count_ - 1].size() == EventResidualBatch::kCapacity) {
    if (batch_count_ == batches_.size()) batches_.emplace_back();
    batches_[batch_count_++].clear();
  }
  batches_[batch_count_ - 1].add(observation, at);
}

void LogIntensityResiduals::prefetch(const Event& event, bool is_aligned) const {
  pixels_.prefetch(pixels_.index(event));
  if (!is_aligned) return;
  const Eigen::Vector2i node = view_.node_at(undistortion_(event.x, event.y));
  if (view_.contains(node.x(), node.y())) __builtin_prefetch(&view_(node.x(), node.y()));
}

const MapSample* LogIntensityResiduals::sample_at(const Eigen::Vector2f& pixel) const {
  const Eigen::Vector2i node = view_.node_at(pixel);
  if (!view_.contains(node.x(), node.y())) return nullptr;
  const MapSample& at = view_(node.x(), node.y());
  return at.inverse_depth > 0 ? &at : nullptr;
}

const MapSample* LogIntensityResiduals::find_sample(
    const Eigen::Vector2f& pixel, float time_s, const EventResidualBatch::Motion& motion) const {
  const auto project = [&](const Eigen::Vector3f& point) -> Eigen::Vector2f {
    const Eigen::Vector3f at = motion.rotation * point + motion.translation;
    const Eigen::Vector3f v = motion.velocity.head<3>();
    const Eigen::Vector3f w = motion.velocity.tail<3>();
    const Eigen::Vector3f moved = at - time_s * (v + w.cross(at));
    return {
        static_cast<float>(camera_.fx) * moved.x() / moved.z() + static_cast<float>(camera_.cx),
        static_cast<float>(camera_.fy) * moved.y() / moved.z() + static_cast<float>(camera_.cy)};
  };
  // What is visible there now was elsewhere in the view that was drawn: one step of a fixed point.
  const MapSample* here = sample_at(pixel);
  if (here == nullptr) return nullptr;
  const Eigen::Vector2f before = pixel + (pixel - project(here->point));
  return before.allFinite() ? sample_at(before) : nullptr;
}

EventResidualBatch::Sums LogIntensityResiduals::evaluate(const EventResidualBatch::Motion& motion) {
  EventResidualBatch::Sums sums;
  for (std::size_t k = 0; k < batch_count_; ++k) {
    batches_[k].evaluate(camera_, map_.atlas(), motion);
    batches_[k].weigh(static_cast<float>(kSigma), kPositionSigma_px);
    batches_[k].add_to(sums);
  }
  return sums;
}

void LogIntensityResiduals::correct() {
  std::size_t i = 0;
  for (std::size_t k = 0; k < batch_count_; ++k)
    for (int j = 0; j < batches_[k].size(); ++j, ++i) {
      if (loaded_pixels_[i] == kNotCorrected) continue;
      const float excess = batches_[k].residual(j);
      if (std::isfinite(excess)) pixels_.correct(loaded_pixels_[i], excess);
    }
  for (const std::uint32_t pixel : loaded_pixels_)
    if (pixel != kNotCorrected) pixels_.end_batch(pixel);
}

}  // namespace saccade
