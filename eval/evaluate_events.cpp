#include "eval/evaluate_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/image.h"
#include "core/io/files/atomic_file.h"
#include "core/io/images/image_file.h"
#include "eval/metrics/catalogue.h"
#include "eval/metrics/event_metrics.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

std::string size_text(const SensorSize& size) {
  return fmt::format("{} x {} pixels", size.width, size.height);
}

SensorSize common_size(const EventRecording& events, const EventRecording& truth) {
  const bool differ =
      events.size.width != truth.size.width || events.size.height != truth.size.height;
  if (events.is_size_stated && truth.is_size_stated && differ)
    throw InputError(
        events.file.string(),
        fmt::format("is of {}, but {} of {}; compare recordings of one sensor",
                    size_text(events.size), truth.file.string(), size_text(truth.size)));
  // Of a file without a sensor a single wrong coordinate decides the size.
  constexpr int kLargest_px = 8192;
  for (const EventRecording* each : {&events, &truth})
    if (std::max(each->size.width, each->size.height) > kLargest_px)
      throw InputError(each->file.string(),
                       fmt::format("has events at up to ({}, {}), beyond any sensor",
                                   each->size.width - 1, each->size.height - 1));
  return {std::max(events.size.width, truth.size.width),
          std::max(events.size.height, truth.size.height)};
}

/// Adds the events without a partner to their pixels.
void count_unmatched(const Events& events, const std::vector<bool>& matched,
                     std::vector<double>& counts, std::size_t width) {
  for (std::size_t i = 0; i < events.size(); ++i)
    if (!matched[i]) counts[events[i].y * width + events[i].x] += 1;
}

/// Pixels by their events without a partner at 10 us: red where events of the truth are missing,
/// green where there are superfluous ones, full from ten on; white where all have one.
ImageRgb8 draw_pixels(const EventRecording& events, const EventRecording& truth,
                      const MatchedEvents& matched, const SensorSize& size) {
  constexpr double kMany = 10;
  const auto width = static_cast<std::size_t>(size.width);
  std::vector<double> extra(width * static_cast<std::size_t>(size.height));
  std::vector<double> missed = extra;
  count_unmatched(events.events, matched.first[kMainTolerance], extra, width);
  count_unmatched(truth.events, matched.second[kMainTolerance], missed, width);
  const auto weight = [](double count) {
    return std::min(1.0, std::log1p(count) / std::log1p(kMany));
  };
  ImageRgb8 picture(size.width, size.height);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
      const Theme& theme = kLightTheme;
      picture(x, y) =
          mix(mix(theme.background, theme.on, weight(extra[i])), theme.off, weight(missed[i]));
    }
  return picture;
}

}  // namespace

Metrics evaluate_events(const EventsToCompare& compared, const std::optional<fs::path>& output) {
  RecordingPart part = compared.part;
  if (part.duration_s && !part.start_s)  // the same part of both
    part.start_s = std::min(recording_start_s(compared.events), recording_start_s(compared.truth));
  const EventRecording events = read_recording(compared.events, part);
  const EventRecording truth = read_recording(compared.truth, part);
  const SensorSize size = common_size(events, truth);
  if (events.events.empty() && truth.events.empty())
    throw InputError(compared.events.string(),
                     "holds no event in this part, and neither does " + compared.truth.string());
  const std::vector<std::uint8_t> origin = read_origins(compared.events, part);
  const std::vector<std::uint8_t> true_origin = read_origins(compared.truth, part);
  const MatchedEvents matched = match_events(events.events, truth.events);
  Metrics metrics =
      catalogued(score_events({events.events, origin}, {truth.events, true_origin}, matched));
  if (!output) return metrics;
  write_png(*output / "pixels.png", draw_pixels(events, truth, matched, size));
  write_atomically(*output / "metrics.json", to_json(metrics));
  return metrics;
}

}  // namespace saccade
