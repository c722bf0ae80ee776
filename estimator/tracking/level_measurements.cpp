#include "estimator/tracking/level_measurements.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace saccade {
namespace {

/// Beyond the image the view is drawn this much further than it may move before it is redrawn.
constexpr int kSpareNodes = 4;

/// Events go to random places: those of a later one are fetched that many events before.
constexpr std::size_t kPlacesAhead = 16;

/// In place of the pixel whose level an alignment corrects.
constexpr std::uint32_t kNotCorrected = std::numeric_limits<std::uint32_t>::max();

/// A view of some 240 columns is fine enough: what lies between its nodes is extrapolated.
int step_of(const PinholeCamera& camera) {
  constexpr double kColumns = 240;
  return std::max(1, static_cast<int>(std::lround(camera.width / kColumns)));
}

double redraw_px(const IntensityOptions& options, const PinholeCamera& camera) {
  return camera.fx * options.redraw_deg * std::numbers::pi / 180;
}

int margin_of(const IntensityOptions& options, const PinholeCamera& camera) {
  return static_cast<int>(std::ceil(redraw_px(options, camera) / step_of(camera))) + kSpareNodes;
}

/// Between its events a pixel is anywhere within a threshold: a uniform deviation beside the noise.
float trust_between_events(const EventContrast& contrast, double noise) {
  const double step = 0.5 * (contrast.on + contrast.off);
  return static_cast<float>(noise * noise / (noise * noise + step * step / 12));
}

}  // namespace

LevelMeasurements::LevelMeasurements(const IntensityOptions& options, const EventContrast& contrast,
                                     const PinholeCamera& camera, const IntensityMap& map)
    : options_(options),
      camera_(camera.undistorted()),
      undistortion_(camera),
      map_(map),
      view_(map, margin_of(options, camera), step_of(camera)),
      levels_(camera.width, camera.height, contrast.on, contrast.off, options.correction),
      between_trust_(trust_between_events(contrast, options.noise)) {}

void LevelMeasurements::restart(const Rigid3& map_from_camera, float looks) {
  first_pixel_ = 0;
  draw_view(map_from_camera);
  start_levels(looks);
}

void LevelMeasurements::prepare_view(const Rigid3& map_from_camera) {
  if (view_.moved_px(map_from_camera) >= redraw_px(options_, camera_)) draw_view(map_from_camera);
}

void LevelMeasurements::draw_view(const Rigid3& map_from_camera) {
  view_.draw(map_from_camera);
  list_steep_pixels();
  ++views_drawn_;
}

void LevelMeasurements::start_levels(float looks) {
  levels_.forget();
  for (int y = 0; y < camera_.height; ++y)
    for (int x = 0; x < camera_.width; ++x) {
      const Eigen::Vector2f pixel = undistortion_(x, y);
      const Eigen::Vector2i node = view_.node_at(pixel);
      if (!view_.contains(node.x(), node.y())) continue;
      const SeenPlace& seen = view_(node.x(), node.y());
      if (!(seen.inverse_depth > 0)) continue;
      const Eigen::Vector2f offset = pixel - (view_.step_px() * node).cast<float>();
      const Eigen::Vector2f place = seen.place + seen.scale * offset;
      if (!is_inside(map_.atlas(), place.x(), place.y())) continue;
      const float level = sample(map_.atlas(), place.x(), place.y());
      if (!std::isfinite(level)) continue;
      levels_.set(static_cast<std::size_t>(y * camera_.width + x), level, looks);
    }
}

void LevelMeasurements::load(std::span<const Event> events, TimeNs t_ns,
                             const EventChunk::Motion& motion) {
  chunk_count_ = 0;
  loaded_pixels_.clear();
  const auto samples = static_cast<std::size_t>(options_.samples);
  // One in `every` events is aligned, the others only count for their pixels.
  const std::size_t every = (events.size() + samples - 1) / samples;
  const auto pixels = static_cast<std::size_t>(std::lround(
      options_.pixels_per_event * static_cast<double>(events.size()) / static_cast<double>(every)));
  bool has_pixels = pixels == 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    // When the pose is sought, half of the events have happened.
    if (!has_pixels && event.t_ns >= t_ns) {
      load_pixels(pixels, motion);
      has_pixels = true;
    }
    const std::size_t ahead = std::min(i + kPlacesAhead, events.size() - 1);
    prefetch(events[ahead], ahead % every == 0);
    const std::size_t pixel = levels_.index(event);
    EventMeasurement measurement;
    measurement.level = levels_.step(pixel, event.polarity);
    if (i % every != 0) continue;
    measurement.pixel = undistortion_(event.x, event.y);
    measurement.time_s = static_cast<float>(seconds_from_ns(event.t_ns - t_ns));
    measurement.trust = levels_.trust(pixel);
    SeenPlace seen;
    if (!find_place(measurement.pixel, measurement.time_s, motion, seen)) continue;
    add(measurement, seen, static_cast<std::uint32_t>(pixel));
  }
}

void LevelMeasurements::load_pixels(std::size_t count, const EventChunk::Motion& motion) {
  // Every n-th of those that tell where they look, others each time.
  const std::size_t every = std::max<std::size_t>(1, steep_pixels_.size() / count);
  constexpr std::size_t kNext = 7919;
  first_pixel_ = (first_pixel_ + kNext) % every;
  Eigen::Vector2f shift;
  for (std::size_t i = first_pixel_; i < steep_pixels_.size(); i += every) {
    const std::size_t pixel = steep_pixels_[i];
    const int x = static_cast<int>(pixel % static_cast<std::size_t>(camera_.width));
    const int y = static_cast<int>(pixel / static_cast<std::size_t>(camera_.width));
    EventMeasurement measurement;
    measurement.level = options_.half_step ? levels_.between(pixel) : levels_.level(pixel);
    measurement.pixel = undistortion_(x, y);
    measurement.time_s = 0;
    measurement.trust = between_trust_ * levels_.trust(pixel);
    SeenPlace seen;
    if (find_place(measurement.pixel, 0, motion, seen)) add(measurement, seen, kNotCorrected);
  }
}

void LevelMeasurements::list_steep_pixels() {
  steep_pixels_.clear();
  if (!(options_.pixels_per_event > 0)) return;
  const auto least = static_cast<float>(options_.least_slope);
  const ImageF& atlas = map_.atlas();
  const int step = view_.step_px();
  for (int y = 0; y < camera_.height; y += step)
    for (int x = 0; x < camera_.width; x += step) {
      const Eigen::Vector2i node = view_.node_at(undistortion_(x, y));
      if (!view_.contains(node.x(), node.y())) continue;
      const SeenPlace& seen = view_(node.x(), node.y());
      if (!(seen.inverse_depth > 0)) continue;
      const int u = static_cast<int>(seen.place.x());
      const int v = static_cast<int>(seen.place.y());
      if (u < 0 || v < 0 || u + 1 >= atlas.width() || v + 1 >= atlas.height()) continue;
      const Eigen::Vector2f slope(atlas(u + 1, v) - atlas(u, v), atlas(u, v + 1) - atlas(u, v));
      // Not so where it is unknown.
      if ((seen.scale.transpose() * slope).squaredNorm() >= least * least)
        steep_pixels_.push_back(static_cast<std::uint32_t>(y * camera_.width + x));
    }
}

void LevelMeasurements::add(const EventMeasurement& measurement, const SeenPlace& seen,
                            std::uint32_t pixel) {
  loaded_pixels_.push_back(pixel);
  if (chunk_count_ == 0 || chunks_[chunk_count_ - 1].size() == EventChunk::kCapacity) {
    if (chunk_count_ == chunks_.size()) chunks_.emplace_back();
    chunks_[chunk_count_++].clear();
  }
  chunks_[chunk_count_ - 1].add(measurement, seen);
}

void LevelMeasurements::prefetch(const Event& event, bool is_aligned) const {
  levels_.prefetch(levels_.index(event));
  if (!is_aligned) return;
  const Eigen::Vector2i node = view_.node_at(undistortion_(event.x, event.y));
  if (view_.contains(node.x(), node.y())) __builtin_prefetch(&view_(node.x(), node.y()));
}

bool LevelMeasurements::find_place(const Eigen::Vector2f& pixel, float time_s,
                                   const EventChunk::Motion& motion, SeenPlace& seen) const {
  const auto project = [&](const Eigen::Vector3f& point) -> Eigen::Vector2f {
    const Eigen::Vector3f at = motion.rotation * point + motion.translation;
    const Eigen::Vector3f v = motion.velocity.head<3>();
    const Eigen::Vector3f w = motion.velocity.tail<3>();
    const Eigen::Vector3f moved = at - time_s * (v + w.cross(at));
    return {
        static_cast<float>(camera_.fx) * moved.x() / moved.z() + static_cast<float>(camera_.cx),
        static_cast<float>(camera_.fy) * moved.y() / moved.z() + static_cast<float>(camera_.cy)};
  };
  const auto look = [&](const Eigen::Vector2f& at) -> const SeenPlace* {
    const Eigen::Vector2i node = view_.node_at(at);
    if (!view_.contains(node.x(), node.y())) return nullptr;
    const SeenPlace& place = view_(node.x(), node.y());
    return place.inverse_depth > 0 ? &place : nullptr;
  };
  // What is seen there now was elsewhere in the view that was drawn: one step of a fixed point.
  const SeenPlace* here = look(pixel);
  if (here == nullptr) return false;
  const Eigen::Vector2f before = pixel + (pixel - project(here->point));
  if (!before.allFinite()) return false;
  const SeenPlace* there = look(before);
  if (there == nullptr) return false;
  seen = *there;
  return true;
}

EventChunk::Sums LevelMeasurements::evaluate(const EventChunk::Motion& motion) {
  const EventChunk::Noise noise{static_cast<float>(options_.noise),
                                static_cast<float>(options_.place_px)};
  EventChunk::Sums sums;
  for (std::size_t k = 0; k < chunk_count_; ++k) {
    chunks_[k].evaluate(camera_, map_.atlas(), motion);
    chunks_[k].weigh(noise);
    chunks_[k].add_to(sums);
  }
  return sums;
}

void LevelMeasurements::correct() {
  std::size_t i = 0;
  for (std::size_t k = 0; k < chunk_count_; ++k)
    for (int j = 0; j < chunks_[k].size(); ++j, ++i) {
      if (loaded_pixels_[i] == kNotCorrected) continue;
      const float excess = chunks_[k].residual(j);
      if (std::isfinite(excess)) levels_.correct(loaded_pixels_[i], excess);
    }
  for (const std::uint32_t pixel : loaded_pixels_)
    if (pixel != kNotCorrected) levels_.settle(pixel);
}

}  // namespace saccade
