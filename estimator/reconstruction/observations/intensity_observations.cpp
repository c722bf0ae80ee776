#include "estimator/reconstruction/observations/intensity_observations.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/check.h"
#include "core/process/parallel.h"
#include "core/stopwatch.h"

namespace saccade {
namespace {

constexpr std::size_t kBatch = 65536;  ///< events at a time
/// Steps at a time, and pictures of surfaces that they hold: some 10 MB.
constexpr std::size_t kMostSteps = 256, kMostSurfaces = 16;
constexpr int kTile_px = 16;  ///< in which no-event constraints have one stride
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
      starts_(camera.width, camera.height),
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
void ReprojectedObservations<Path>::plan(std::span<const Event> events, std::size_t bands) {
  changes_.weigh(events, {pixels_.width(), pixels_.height()});
  // The log intensity goes on beyond the last events of leaking pixels as often up as down, though more of these are ON.
  // Before a first event it is expected at the reference as ever: expected at the start of it, no image was better.
  const float polarity = changes_.bias().last_polarity;
  kinds_[kNoEventAfterOn].expected = expected_ * (1 - polarity);
  kinds_[kNoEventAfterOff].expected = -expected_ * (1 + polarity);
  thin_constraints(events);
  divide(events, bands);
}

template <class Path>
void ReprojectedObservations<Path>::thin_constraints(std::span<const Event> events) {
  Image<int> counts(strides_.width(), strides_.height());
  for (const Event& event : events) ++counts(event.x / kTile_px, event.y / kTile_px);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double ratio = counts.pixels()[i] / (options_.dense_events_per_px * kTile_px * kTile_px);
    strides_.pixels()[i] = static_cast<int>(options_.no_event_stride * std::max(ratio, 1.0));
  }
}

/// The pixels of a row take about as long as its events on average.
template <class Path>
void ReprojectedObservations<Path>::divide(std::span<const Event> events, std::size_t bands) {
  const int height = pixels_.height();
  const auto rows = static_cast<std::size_t>(height);
  std::vector<std::size_t> work(rows, std::max<std::size_t>(events.size() / rows, 1));
  for (const Event& event : events) ++work[event.y];
  const std::size_t all = std::accumulate(work.begin(), work.end(), std::size_t{0});
  bands_.assign(bands, {});
  band_of_row_.resize(rows);
  std::size_t before = 0;
  for (std::size_t row = 0; row < rows; before += work[row++])
    band_of_row_[row] = std::min(before * bands / all, bands - 1);
  for (std::size_t band = 0; band < bands; ++band) {
    const auto [begin, end] = std::equal_range(band_of_row_.begin(), band_of_row_.end(), band);
    bands_[band].rows = {static_cast<int>(begin - band_of_row_.begin()),
                         static_cast<int>(end - band_of_row_.begin())};
  }
}

/// The steps of the next batch are found beside the bands of this one: the surfaces are rendered one after the other.
template <class Path>
double ReprojectedObservations<Path>::observe(std::span<const Event> events,
                                              const Trajectory& world_from_camera,
                                              std::size_t bands, const ObservationSink& use,
                                              const std::function<void(double)>& done) {
  SACCADE_CHECK(bands > 0 && !newest_);
  double seconds = 0;
  Batch batch;
  {
    const ScopedTimer clock(seconds);
    plan(events, bands);
    batch = next_batch(events, world_from_camera);
  }
  for (std::size_t end = 0; !batch.steps.empty();) {
    {
      const ScopedTimer clock(seconds);
      end += batch.events.size();
      for (Band& band : bands_) band.events.clear();
      for (const Event& event : batch.events) bands_[band_of_row_[event.y]].events.push_back(event);
      Batch next;
      parallel_for(bands_.size() + 1, [&](std::size_t i) {
        if (i == 0) {
          next = next_batch(events.subspan(end), world_from_camera);
        } else {
          observe_band(batch.steps, bands_[i - 1]);
          use(i - 1, bands_[i - 1].observations);
        }
      });
      batch = std::move(next);
    }
    done(static_cast<double>(end) / static_cast<double>(events.size()));
  }
  return seconds;
}

template <class Path>
auto ReprojectedObservations<Path>::next_batch(std::span<const Event> events,
                                               const Trajectory& world_from_camera) -> Batch {
  Batch batch;
  if (events.empty()) return batch;
  batch.events = events.first(std::min(kBatch, events.size()));
  if (!newest_) batch.steps.push_back(first_step(world_from_camera, events.front().t_ns));
  const TimeNs last_ns = batch.events.back().t_ns;
  std::size_t surfaces = 0;
  do {
    Step step;
    step.begin = *newest_;
    step.end = path_.next(step.begin, world_from_camera, last_ns);
    if (!step.end.has_surfaces_of(step.begin)) ++surfaces;
    newest_ = step.end;
    if (options_.no_event_constraints) time_constraints(step);
    batch.steps.push_back(std::move(step));
  } while (newest_->t_ns < last_ns && batch.steps.size() < kMostSteps && surfaces < kMostSurfaces);
  const TimeNs end_ns = newest_->t_ns;
  const auto later = std::partition_point(batch.events.begin(), batch.events.end(),
                                          [&](const Event& e) { return e.t_ns <= end_ns; });
  batch.events = batch.events.first(static_cast<std::size_t>(later - batch.events.begin()));
  return batch;
}

template <class Path>
auto ReprojectedObservations<Path>::first_step(const Trajectory& world_from_camera, TimeNs t_ns)
    -> Step {
  Step step;
  step.end = path_.first(world_from_camera, t_ns);
  step.is_first = true;
  if (options_.no_event_constraints) step.constraints.push_back({t_ns, 0, constrained_++});
  newest_ = step.end;
  constrained_from_reference_ = inverse_of(step.end.pose());
  return step;
}

/// The image moves nearly evenly from one instant to the next, by a few pixels at most; where poses jump, as if it did.
template <class Path>
void ReprojectedObservations<Path>::time_constraints(Step& step) {
  constexpr double kMost_px = 2;
  const auto add = [&](double fraction) {
    const TimeNs interval_ns = step.end.t_ns - step.begin.t_ns;
    step.constraints.push_back(
        {step.begin.t_ns + static_cast<TimeNs>(fraction * static_cast<double>(interval_ns)),
         static_cast<float>(fraction), constrained_++});
    constrained_from_reference_ = inverse_of(
        saccade::between(step.begin.pose(), step.end.pose(), static_cast<float>(fraction)));
  };
  const double spacing_px = options_.no_event_spacing_px;
  const double before_px = path_.moved_px(step.begin, constrained_from_reference_);
  const double after_px = path_.moved_px(step.end, constrained_from_reference_);
  if (after_px < spacing_px) return;
  const double step_px = path_.moved_px(step.end, inverse_of(step.begin.pose()));
  // Points are behind the camera.
  if (!std::isfinite(before_px) || !std::isfinite(after_px) || !(step_px > 0)) {
    add(1);
    return;
  }
  const double apart = spacing_px / std::min(step_px, kMost_px);
  const double first =
      before_px < spacing_px ? (spacing_px - before_px) / (after_px - before_px) : 0.0;
  const int count = 1 + static_cast<int>((1 - first) / apart);
  for (int i = 0; i < count; ++i) add(first + i * apart);
}

template <class Path>
void ReprojectedObservations<Path>::observe_band(std::span<const Step> steps, Band& band) {
  band.observations.clear();
  auto event = band.events.begin();
  for (const Step& step : steps) {
    path_.follow(step.end, band.rows);
    if (step.is_first && options_.first_event_sigma > 0) note_starts(step.end, band.rows);
    for (const ConstraintTime& time : step.constraints) {
      for (; !step.is_first && event != band.events.end() && event->t_ns <= time.t_ns; ++event)
        observe_event(*event, step, band);
      add_no_event_constraints(time, step, band);
    }
    for (; !step.is_first && event != band.events.end() && event->t_ns <= step.end.t_ns; ++event)
      observe_event(*event, step, band);
  }
}

template <class Path>
void ReprojectedObservations<Path>::observe_event(const Event& event, const Step& step,
                                                  Band& band) {
  Pixel& pixel = pixels_(event.x, event.y);
  pixel.last_change = changes_.next(event, pixel.level);
  pixel.log_intensity += pixel.last_change;  // (2.8)
  if (const auto reprojection = path_.of(event, step.begin, step.end))
    add_event(event, *reprojection, band);
}

template <class Path>
void ReprojectedObservations<Path>::note_starts(const Instant& instant, PixelRows rows) {
  for (int y = rows.begin; y < rows.end; ++y)
    for (int x = 0; x < pixels_.width(); ++x)
      if (const auto reprojection = path_.at(x, y, instant))
        starts_(x, y) = {reprojection->x, reprojection->y};
}

template <class Path>
void ReprojectedObservations<Path>::add_event(const Event& event, const Reprojection& reprojection,
                                              Band& band) {
  std::vector<IntensityObservation>& observations = band.observations;
  Pixel& pixel = pixels_(event.x, event.y);
  const auto tolerance = static_cast<float>(kSameSurfaceRatio);
  const bool is_on = event.polarity > 0;
  const bool is_jump =
      pixel.events > 0 && (std::abs(reprojection.inverse_depth - pixel.inverse_depth) >
                               tolerance * pixel.inverse_depth ||
                           event.t_ns - pixel.t_ns < kSimultaneousNs);
  if (pixel.events == 0 || pixel.events >= options_.run_events) {
    const bool has_earlier_run = pixel.events > 0;
    pixel.run = band.runs++;
    if (has_earlier_run)
      observations.push_back({pixel.x, pixel.y, pixel.log_intensity - pixel.last_change,
                              IntensityObservation::tag(pixel.run, kEvent)});
    pixel.events = 0;
  }
  if (const Start start = pixel.last_polarity == 0 ? starts_(event.x, event.y) : Start();
      start.x != kNowhere)
    observations.push_back(
        {start.x, start.y, changes_.bias().start, IntensityObservation::tag(pixel.run, kStart)});
  const Kind kind = !is_jump ? kEvent : is_on ? kJumpOn : kJumpOff;
  observations.push_back({reprojection.x, reprojection.y, pixel.log_intensity,
                          IntensityObservation::tag(pixel.run, kind)});
  pixel.inverse_depth = reprojection.inverse_depth;
  pixel.x = pixel.observed_x = reprojection.x;
  pixel.y = pixel.observed_y = reprojection.y;
  pixel.t_ns = event.t_ns;
  ++pixel.events;
  pixel.last_polarity = event.polarity > 0 ? 1 : -1;
}

template <class Path>
void ReprojectedObservations<Path>::add_no_event_constraints(const ConstraintTime& time,
                                                             const Step& step, Band& band) {
  // Neighbours in both directions alternate, so that the view is covered evenly.
  const int width = pixels_.width();
  for (int y = band.rows.begin; y < band.rows.end; ++y)
    for (int left = 0; left < width; left += kTile_px) {
      const int stride = strides_(left / kTile_px, y / kTile_px);
      const int right = std::min(left + kTile_px, width);
      const int shift = (time.number + (stride / 2) * y - left) % stride;
      for (int x = left + (shift < 0 ? shift + stride : shift); x < right; x += stride) {
        const auto reprojection = step.is_first
                                      ? path_.at(x, y, step.end)
                                      : path_.between(x, y, step.begin, step.end, time.fraction);
        if (reprojection) add_no_event_constraint(x, y, *reprojection, band);
      }
    }
}

template <class Path>
void ReprojectedObservations<Path>::add_no_event_constraint(int x, int y,
                                                            const Reprojection& reprojection,
                                                            Band& band) {
  Pixel& pixel = pixels_(x, y);
  if (pixel.events == 0) {
    pixel.run = band.runs++;
    pixel.events = 1;
  } else if (const float moved_x = reprojection.x - pixel.observed_x,
             moved_y = reprojection.y - pixel.observed_y;
             static_cast<double>(moved_x * moved_x + moved_y * moved_y) <
             kMinSquaredMotionRatio * options_.no_event_spacing_px * options_.no_event_spacing_px) {
    return;
  }
  const Kind kind = pixel.last_polarity > 0   ? kNoEventAfterOn
                    : pixel.last_polarity < 0 ? kNoEventAfterOff
                                              : kNoEvent;
  band.observations.push_back({reprojection.x, reprojection.y, pixel.log_intensity,
                               IntensityObservation::tag(pixel.run, kind)});
  pixel.observed_x = reprojection.x;
  pixel.observed_y = reprojection.y;
}

template class ReprojectedObservations<SurfaceReprojection>;
template class ReprojectedObservations<PanoramaReprojection>;

}  // namespace saccade
