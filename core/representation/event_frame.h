#pragma once

#include <span>
#include <vector>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/io/events/event_file.h"
#include "core/representation/event_window.h"
#include "core/representation/voxel_grid.h"

namespace saccade {

struct FrameGridOptions {
  enum class Kind { kCount, kPolarity, kTimeSurface };

  Kind kind = Kind::kPolarity;
  double decay_s = 0.03;  ///< of the time surface
  WindowOptions window;

  [[nodiscard]] int channels() const { return kind == Kind::kCount ? 1 : 2; }
};

void describe(config::Fields& fields, FrameGridOptions& options);

/// Frames of windows that follow one another:
///   count: number of events in the window;   polarity: of ON events, of OFF events
///   time surface: exp(-(t_1 - t) / decay_s) of the last ON event and of the last OFF event up to
///   the end t_1 of the window, also before its start; 0 where there was none (Lagorce et al.,
///   TPAMI 2017)
class EventFrameMaker {
 public:
  EventFrameMaker(SensorSize size, const FrameGridOptions& options);

  /// `events`: those of the window.
  [[nodiscard]] EventGrid next(std::span<const Event> events, const GridWindow& window);

 private:
  [[nodiscard]] EventGrid counts(std::span<const Event> events) const;
  [[nodiscard]] EventGrid time_surface(std::span<const Event> events, TimeNs end_ns);
  /// Of an event, in a grid of two channels or one.
  [[nodiscard]] std::size_t index(const Event& event) const;

  SensorSize size_;
  FrameGridOptions options_;
  std::vector<TimeNs> last_ns_;  ///< of the time surface, by channel and pixel
};

}  // namespace saccade
