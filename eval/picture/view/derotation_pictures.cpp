#include "eval/picture/view/derotation_pictures.h"

#include <fmt/format.h>

#include <cstddef>
#include <span>
#include <string>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/image/derotation_picture.h"
#include "eval/picture/image/event_picture.h"
#include "eval/picture/image/log_picture.h"
#include "eval/table/number_text.h"

namespace saccade {

std::vector<CaptionedPicture> derotation_pictures(const Dataset& dataset, double t_s, int factor) {
  constexpr double kReachS = 0.2;
  const Trajectory& truth = dataset.groundtruth();
  if (truth.empty() || dataset.events_file().empty()) return {};
  const PinholeCamera& camera = dataset.camera();
  // One per pixel: some 50 ms, over which rotation blurs and translation hardly does.
  const auto most =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  const Events around = dataset.load_events(t_s - kReachS, t_s + kReachS);
  const std::span<const Event> events = events_around(around, t_s, most, kReachS);
  if (events.empty()) return {};
  const ImageF derotated = count_derotated_events(events, camera, truth, t_s);
  const float top = quantile(derotated, {}, 0.99);
  const std::string what = fmt::format(
      "{} events of {:.0f} ms around {:.3f} s", grouped(static_cast<double>(events.size())),
      1e3 * seconds_from_ns(events.back().t_ns - events.front().t_ns), t_s);
  return {{what + ", as they came",
           upscale(draw_magnitude(count_events(events, camera), {}, top), factor)},
          {"rotated into the view's orientation by the true poses",
           upscale(draw_magnitude(derotated, {}, top), factor)}};
}

}  // namespace saccade
