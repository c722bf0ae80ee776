#include "estimator/refinement/poses/log_intensity_chains.h"

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "estimator/refinement/poses/pixel_choice.h"

namespace saccade {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// How far a pixel has come.
struct PixelChain {
  double level = 0;
  std::uint32_t chain = kNone;
  int length = 0;  ///< of the chain so far
};

/// Leaves out chains of one observation and numbers the others anew.
void drop_single(LogIntensityChains& result) {
  std::vector<std::uint32_t> length(result.chains);
  for (const ChainObservation& o : result.observations) ++length[o.chain];
  std::vector<std::uint32_t> number(result.chains, kNone);
  result.chains = 0;
  for (std::size_t i = 0; i < length.size(); ++i)
    if (length[i] > 1) number[i] = static_cast<std::uint32_t>(result.chains++);
  std::erase_if(result.observations,
                [&](const ChainObservation& o) { return number[o.chain] == kNone; });
  for (ChainObservation& o : result.observations) o.chain = number[o.chain];
}

}  // namespace

LogIntensityChains observe_log_intensity(std::span<const Event> events, const PinholeCamera& camera,
                                         const EventContrast& contrast, int max_events,
                                         int max_length) {
  SACCADE_CHECK(max_events > 0 && max_length >= 2);
  const double fraction = static_cast<double>(max_events) / static_cast<double>(events.size());
  const UndistortionTable undistortion(camera);
  const PinholeCamera undistorted = camera.undistorted();
  std::vector<PixelChain> pixels(static_cast<std::size_t>(camera.width) *
                                 static_cast<std::size_t>(camera.height));
  LogIntensityChains result;
  for (const Event& event : events) {
    const std::size_t index =
        static_cast<std::size_t>(event.y) * static_cast<std::size_t>(camera.width) + event.x;
    if (!is_chosen(index, fraction)) continue;
    PixelChain& pixel = pixels[index];
    pixel.level += event.polarity > 0 ? contrast.on : -contrast.off;
    if (pixel.chain == kNone || pixel.length == max_length) {
      pixel.chain = static_cast<std::uint32_t>(result.chains++);
      pixel.length = 0;
    }
    ++pixel.length;
    const Eigen::Vector2f& at = undistortion(event.x, event.y);
    result.observations.push_back({seconds_from_ns(event.t_ns), at,
                                   undistorted.ray(at.cast<double>()), pixel.level, pixel.chain});
  }
  drop_single(result);
  return result;
}

}  // namespace saccade
