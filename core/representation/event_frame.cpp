#include "core/representation/event_frame.h"

#include <cmath>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

constexpr TimeNs kNever = std::numeric_limits<TimeNs>::min();

}  // namespace

void describe(config::Fields& fields, FrameGridOptions& options) {
  fields.choice("kind", options.kind,
                {{"count", FrameGridOptions::Kind::kCount},
                 {"polarity", FrameGridOptions::Kind::kPolarity},
                 {"time_surface", FrameGridOptions::Kind::kTimeSurface}},
                "Number of events, numbers of ON and of OFF events, or how long ago the last ON "
                "and the last OFF event was.");
  if (options.kind == FrameGridOptions::Kind::kTimeSurface)
    fields.value("decay_s", options.decay_s, "Time constant of the time surface, in seconds.")
        .range(1e-6, 1e6);
  describe_windows(fields, options.window);
}

EventFrameMaker::EventFrameMaker(SensorSize size, const FrameGridOptions& options)
    : size_(size), options_(options) {
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  if (options_.kind == FrameGridOptions::Kind::kTimeSurface) last_ns_.assign(2 * pixels, kNever);
}

std::size_t EventFrameMaker::index(const Event& event) const {
  SACCADE_CHECK(event.x < size_.width && event.y < size_.height);
  const auto width = static_cast<std::size_t>(size_.width);
  const std::size_t pixel = event.y * width + event.x;
  const bool is_second = options_.channels() == 2 && event.polarity < 0;
  return pixel + (is_second ? width * static_cast<std::size_t>(size_.height) : 0);
}

EventGrid EventFrameMaker::next(std::span<const Event> events, const GridWindow& window) {
  if (options_.kind == FrameGridOptions::Kind::kTimeSurface)
    return time_surface(events, window.to_ns);
  return counts(events);
}

EventGrid EventFrameMaker::counts(std::span<const Event> events) const {
  const auto pixels =
      static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height);
  EventGrid grid(static_cast<std::size_t>(options_.channels()) * pixels);
  for (const Event& event : events) ++grid[index(event)];
  return grid;
}

EventGrid EventFrameMaker::time_surface(std::span<const Event> events, TimeNs end_ns) {
  for (const Event& event : events) last_ns_[index(event)] = event.t_ns;
  EventGrid grid(last_ns_.size());
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (last_ns_[i] != kNever)
      grid[i] =
          static_cast<float>(std::exp(-seconds_from_ns(end_ns - last_ns_[i]) / options_.decay_s));
  return grid;
}

}  // namespace saccade
