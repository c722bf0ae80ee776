#include "estimator/reconstruction/observations/intensity_observations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stopwatch.h"

namespace saccade {
namespace {

constexpr std::size_t kBatch = 65536;  ///< events per call of observe()
constexpr int kTile_px = 16;           ///< in which no-event constraints have one stride
constexpr TimeNs kSimultaneousNs = 2000;

/// A no-event constraint needs this fraction of no_event_spacing_px of motion, squared, since the
/// pixel's last observation; with less it adds nothing.
constexpr double kMinSquaredMotionRatio = 0.25;

}  // namespace

void describe(config::Fields& fields, ObservationOptions& options, bool has_surfaces) {
  fields
      .value("event_sigma", options.event_sigma,
             "Standard deviation of the log intensity at an event about the sum of its pixel's "
             "thresholds, in log units; noisy recordings need more.")
      .range(1e-4, 10);
  fields
      .value("run_events", options.run_events,
             "Events of a pixel in a row (an event run) that share one unknown offset; the event "
             "before them shares it, too, so that 1 compares neighbouring events alone. Thresholds "
             "of real pixels drift, so that long runs bend the image; short ones lose its low "
             "spatial frequencies.")
      .range(1, 1e9);
  fields.value("no_event_constraints", options.no_event_constraints,
               "Whether a pixel that moved without an event constrains the log intensity to within "
               "a threshold.");
  fields
      .value(
          "no_event_spacing_px", options.no_event_spacing_px,
          "Image motion after which no-event constraints are added anew, in pixels: with method: "
          "gradient to every pixel, with equations to every fourth, another one each time. "
          "Smaller values give better images of smooth parts and take longer.")
      .range(0.1, 1000);
  fields
      .value("blind_time_us", options.blind_time_us,
             "For so long a pixel is blind after an event, in us: what it misses meanwhile is "
             "added by the slope around "
             "it. ~ finds it by the shortest times between two events of a pixel; 0: pixels miss "
             "nothing.")
      .range(0, 1e6);
  fields.value("remove_bias", options.remove_bias,
               "Whether to remove what pixels gain on average over a window: those that leak begin "
               "a part of a threshold below "
               "what they see, and fast ones miss more falls than rises or the reverse. false sums "
               "rises and falls up as "
               "they come.");
  if (!has_surfaces) return;
  fields
      .value("redraw_parallax_px", options.reprojection.redraw_parallax_px,
             "Parallax at depth discontinuities after which the depth map of the depth test is "
             "rendered anew, in pixels; larger values are faster and mix surfaces.")
      .range(0.01, 100);
  fields
      .value(
          "discontinuity_margin_px", options.reprojection.discontinuity_margin_px,
          "Pixels closer than this to a depth discontinuity are not used, in pixels; 0 uses all.")
      .range(0, 20);
}

double ObservationSource::observe_all(
    std::span<const Event> events, const Trajectory& world_from_camera,
    const std::function<void(std::span<const IntensityObservation>, double)>& use) {
  double seconds = 0;
  {
    const ScopedTimer clock(seconds);
    plan(events);
  }
  std::vector<IntensityObservation> part;
  for (std::size_t begin = 0; begin < events.size(); begin += kBatch) {
    part.clear();
    const std::size_t count = std::min(kBatch, events.size() - begin);
    {
      const ScopedTimer clock(seconds);
      observe(events.subspan(begin, count), world_from_camera, part);
    }
    use(part, static_cast<double>(begin + count) / static_cast<double>(events.size()));
  }
  return seconds;
}

template <class Path>
ReprojectedObservations<Path>::ReprojectedObservations(Path path, const PinholeCamera& camera,
                                                       const ContrastThresholds& thresholds,
                                                       const ObservationOptions& options)
    : path_(std::move(path)),
      contrast_on_(static_cast<float>(thresholds.on)),
      contrast_off_(static_cast<float>(thresholds.off)),
      expected_((contrast_on_ + contrast_off_) / 2 * static_cast<float>(options.expected_fraction)),
      changes_(thresholds, 1e-6 * options.blind_time_us.value_or(0), options.remove_bias),
      options_(options),
      pixels_(camera.width, camera.height),
      strides_((camera.width - 1) / kTile_px + 1, (camera.height - 1) / kTile_px + 1,
               options.no_event_stride) {
  // At an occluding contour the log intensity jumps past the threshold by up to one more of them, and
  // so it does at simultaneous events. After a last event it went on beyond it by up to a threshold
  // (C / 2 +- C / sqrt(12)); without an event so far it may be on either side.
  const auto sigma = static_cast<float>(options.event_sigma);
  const float contrast = (contrast_on_ + contrast_off_) / 2;
  kinds_[kEvent] = {sigma, 0, 0};
  kinds_[kStart] = {contrast * static_cast<float>(std::max(options.first_event_sigma, 1e-3)), 0, 0};
  kinds_[kJumpOn] = {std::hypot(sigma, contrast_on_), 0, 0};
  kinds_[kJumpOff] = {std::hypot(sigma, contrast_off_), 0, 0};
  kinds_[kNoEvent] = {contrast / std::sqrt(3.0F), contrast, 0};
  kinds_[kNoEventAfterOn] = {contrast / std::sqrt(12.0F), contrast, expected_};
  kinds_[kNoEventAfterOff] = {contrast / std::sqrt(12.0F), contrast, -expected_};
  for (ObservationKind& kind : kinds_) kind.weight = 1 / (kind.sigma * kind.sigma);
}

template <class Path>
void ReprojectedObservations<Path>::plan(std::span<const Event> events) {
  changes_.weigh(events, {pixels_.width(), pixels_.height()});
  // The log intensity goes on beyond the last events of leaking pixels as often up as down, though more of these are ON.
  // Before a first event it is expected at the reference as ever: expected at the start of it, no image was better.
  const float polarity = changes_.bias().last_polarity;
  kinds_[kNoEventAfterOn].expected = expected_ * (1 - polarity);
  kinds_[kNoEventAfterOff].expected = -expected_ * (1 + polarity);
  Image<int> counts(strides_.width(), strides_.height());
  for (const Event& event : events) ++counts(event.x / kTile_px, event.y / kTile_px);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double ratio = counts.pixels()[i] / (options_.dense_events_per_px * kTile_px * kTile_px);
    strides_.pixels()[i] = static_cast<int>(options_.no_event_stride * std::max(ratio, 1.0));
  }
}

template <class Path>
void ReprojectedObservations<Path>::observe(std::span<const Event> events,
                                            const Trajectory& world_from_camera,
                                            std::vector<IntensityObservation>& observations) {
  if (events.empty()) return;
  if (constrained_ == 0) {
    path_.start(world_from_camera, events.front().t_ns);
    if (options_.first_event_sigma > 0) note_starts();
    add_no_event_constraints(observations);
  }
  const TimeNs last_ns = events.back().t_ns;
  for (std::size_t i = 0; i < events.size();) {
    path_.advance(world_from_camera, last_ns);
    for (; i < events.size() && events[i].t_ns <= path_.end_ns(); ++i) {
      Pixel& pixel = pixels_(events[i].x, events[i].y);
      pixel.last_change = changes_.next(events[i], pixel.level);
      pixel.log_intensity += pixel.last_change;  // (2.8)
      if (const auto reprojection = path_.of(events[i]))
        add_event(events[i], *reprojection, observations);
    }
    if (options_.no_event_constraints &&
        path_.moved_px(constrained_from_reference_) >= 0.9 * options_.no_event_spacing_px)
      add_no_event_constraints(observations);
  }
}

template <class Path>
void ReprojectedObservations<Path>::note_starts() {
  for (int y = 0; y < pixels_.height(); ++y)
    for (int x = 0; x < pixels_.width(); ++x)
      if (const auto reprojection = path_.at_end(x, y)) {
        pixels_(x, y).start_x = reprojection->x;
        pixels_(x, y).start_y = reprojection->y;
      }
}

template <class Path>
void ReprojectedObservations<Path>::add_event(const Event& event, const Reprojection& reprojection,
                                              std::vector<IntensityObservation>& observations) {
  Pixel& pixel = pixels_(event.x, event.y);
  const auto tolerance = static_cast<float>(kSameSurfaceRatio);
  const bool is_on = event.polarity > 0;
  const bool is_jump =
      pixel.events > 0 && (std::abs(reprojection.inverse_depth - pixel.inverse_depth) >
                               tolerance * pixel.inverse_depth ||
                           event.t_ns - pixel.t_ns < kSimultaneousNs);
  if (pixel.events == 0 || pixel.events >= options_.run_events) {
    const bool has_earlier_run = pixel.events > 0;
    pixel.run = runs_++;
    if (has_earlier_run)
      observations.push_back({pixel.x, pixel.y, pixel.log_intensity - pixel.last_change,
                              IntensityObservation::tag(pixel.run, kEvent)});
    pixel.events = 0;
  }
  if (pixel.last_polarity == 0 && pixel.start_x != kNowhere)
    observations.push_back({pixel.start_x, pixel.start_y, changes_.bias().start,
                            IntensityObservation::tag(pixel.run, kStart)});
  const Kind kind = !is_jump ? kEvent : is_on ? kJumpOn : kJumpOff;
  observations.push_back({reprojection.x, reprojection.y, pixel.log_intensity,
                          IntensityObservation::tag(pixel.run, kind)});
  pixel.inverse_depth = reprojection.inverse_depth;
  pixel.x = pixel.observed_x = reprojection.x;
  pixel.y = pixel.observed_y = reprojection.y;
  pixel.t_ns = event.t_ns;
  ++pixel.events;
  pixel.last_polarity = event.polarity;
}

template <class Path>
void ReprojectedObservations<Path>::add_no_event_constraints(
    std::vector<IntensityObservation>& observations) {
  constrained_from_reference_ = inverse_of(path_.end_pose());
  // Neighbours in both directions alternate, so that the view is covered evenly.
  const int width = pixels_.width();
  for (int y = 0; y < pixels_.height() && options_.no_event_constraints; ++y)
    for (int left = 0; left < width; left += kTile_px) {
      const int stride = strides_(left / kTile_px, y / kTile_px);
      const int right = std::min(left + kTile_px, width);
      const int shift = (constrained_ + (stride / 2) * y - left) % stride;
      for (int x = left + (shift < 0 ? shift + stride : shift); x < right; x += stride)
        add_no_event_constraint(x, y, observations);
    }
  ++constrained_;
}

template <class Path>
void ReprojectedObservations<Path>::add_no_event_constraint(
    int x, int y, std::vector<IntensityObservation>& observations) {
  const auto reprojection = path_.at_end(x, y);
  if (!reprojection) return;
  Pixel& pixel = pixels_(x, y);
  if (pixel.events == 0) {
    pixel.run = runs_++;
    pixel.events = 1;
  } else if (const float moved_x = reprojection->x - pixel.observed_x,
             moved_y = reprojection->y - pixel.observed_y;
             static_cast<double>(moved_x * moved_x + moved_y * moved_y) <
             kMinSquaredMotionRatio * options_.no_event_spacing_px * options_.no_event_spacing_px) {
    return;
  }
  const Kind kind = pixel.last_polarity > 0   ? kNoEventAfterOn
                    : pixel.last_polarity < 0 ? kNoEventAfterOff
                                              : kNoEvent;
  observations.push_back({reprojection->x, reprojection->y, pixel.log_intensity,
                          IntensityObservation::tag(pixel.run, kind)});
  pixel.observed_x = reprojection->x;
  pixel.observed_y = reprojection->y;
}

template class ReprojectedObservations<SurfaceReprojection>;
template class ReprojectedObservations<PanoramaReprojection>;

}  // namespace saccade
