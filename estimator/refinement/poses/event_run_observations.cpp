#include "estimator/refinement/poses/event_run_observations.h"

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "estimator/refinement/poses/pixel_choice.h"

namespace saccade {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// How far a pixel has come.
struct PixelRun {
  double relative_log_intensity = 0;
  std::uint32_t run = kNone;
  int length = 0;  ///< of the run so far
};

/// Leaves out runs of one observation and numbers the others anew.
void drop_single(EventRunObservations& result) {
  std::vector<std::uint32_t> length(result.runs);
  for (const EventRunObservation& o : result.observations) ++length[o.run];
  std::vector<std::uint32_t> number(result.runs, kNone);
  result.runs = 0;
  for (std::size_t i = 0; i < length.size(); ++i)
    if (length[i] > 1) number[i] = static_cast<std::uint32_t>(result.runs++);
  std::erase_if(result.observations,
                [&](const EventRunObservation& o) { return number[o.run] == kNone; });
  for (EventRunObservation& o : result.observations) o.run = number[o.run];
}

}  // namespace

EventRunObservations observe_log_intensity(std::span<const Event> events,
                                           const PinholeCamera& camera,
                                           const EventContrast& contrast, int max_events,
                                           int max_length) {
  SACCADE_CHECK(max_events > 0 && max_length >= 2);
  const double fraction = static_cast<double>(max_events) / static_cast<double>(events.size());
  const UndistortionTable undistortion(camera);
  const PinholeCamera undistorted = camera.undistorted();
  std::vector<PixelRun> pixels(static_cast<std::size_t>(camera.width) *
                               static_cast<std::size_t>(camera.height));
  EventRunObservations result;
  for (const Event& event : events) {
    const std::size_t index =
        static_cast<std::size_t>(event.y) * static_cast<std::size_t>(camera.width) + event.x;
    if (!is_chosen(index, fraction)) continue;
    PixelRun& pixel = pixels[index];
    pixel.relative_log_intensity += event.polarity > 0 ? contrast.on : -contrast.off;
    if (pixel.run == kNone || pixel.length == max_length) {
      pixel.run = static_cast<std::uint32_t>(result.runs++);
      pixel.length = 0;
    }
    ++pixel.length;
    const Eigen::Vector2f& at = undistortion(event.x, event.y);
    result.observations.push_back({seconds_from_ns(event.t_ns), at,
                                   undistorted.ray(at.cast<double>()), pixel.relative_log_intensity,
                                   pixel.run});
  }
  drop_single(result);
  return result;
}

}  // namespace saccade
