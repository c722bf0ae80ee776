#include "estimator/reconstruction/observations/level_changes.h"

#include <algorithm>
#include <cmath>

#include "core/image.h"

namespace saccade {
namespace {

/// Of the blind time: pixels that fire sooner after it see a step rather than a ramp, and its blind part is not
/// steeper by as much as that would say.
constexpr float kLeastSeen = 0.5F;
/// Rises and falls of a window that is short or gets darker need not cancel out.
constexpr double kMostWeight = 1.5;

}  // namespace

LevelChanges::LevelChanges(const ContrastThresholds& thresholds, double blind_s, bool removes_bias)
    : on_(static_cast<float>(thresholds.on)),
      off_(static_cast<float>(thresholds.off)),
      blind_ns_(static_cast<float>(1e9 * blind_s)),
      removes_bias_(removes_bias) {}

float LevelChanges::seen_ns(TimeNs interval_ns) const {
  return std::max(static_cast<float>(interval_ns) - blind_ns_, kLeastSeen * blind_ns_);
}

float LevelChanges::blind_change(const Event& event, Pixel& pixel) const {
  float change = 0;
  if (pixel.polarity != 0) {
    const float slope = threshold(event) / seen_ns(event.t_ns - pixel.t_ns);
    change = blind_ns_ * (pixel.slope + slope) / 2;
    pixel.slope = slope;
  }
  return change;
}

void LevelChanges::weigh(std::span<const Event> events, SensorSize size) {
  weigh_blind(events, size);
  bias_ = removes_bias_ ? bias_of(events, size) : ChangeBias();
}

ChangeBias LevelChanges::bias_of(std::span<const Event> events, SensorSize size) const {
  ChangeBiasFit fit(size);
  Image<Pixel> pixels(size.width, size.height);
  for (const Event& event : events) {
    Pixel& pixel = pixels(event.x, event.y);
    const Pixel before = pixel;
    const float change = biased(event, pixel);
    if (before.polarity == 0)
      fit.add_first(event, change);
    else
      fit.add(event, change, event.t_ns - before.t_ns, before.polarity);
  }
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (const Pixel& pixel = pixels(x, y); pixel.polarity != 0)
        fit.add_rest(x, y, events.back().t_ns - pixel.t_ns, pixel.polarity);
  return fit.found();
}

void LevelChanges::weigh_blind(std::span<const Event> events, SensorSize size) {
  rise_weight_ = fall_weight_ = 0;
  if (blind_ns_ == 0) return;
  Image<Pixel> pixels(size.width, size.height);
  double seen = 0, rises = 0, falls = 0, pairs = 0, agreeing = 0;
  // Some pixels tell it as well as all.
  constexpr std::size_t kEnoughEvents = 250'000;
  const auto step = static_cast<int>(events.size() / kEnoughEvents) + 1;
  for (const Event& event : events) {
    if ((event.y * size.width + event.x) % step != 0) continue;
    Pixel& pixel = pixels(event.x, event.y);
    if (pixel.polarity != 0) {
      // Steep slopes count as much as their blind changes.
      const double weight = 1 / static_cast<double>(seen_ns(event.t_ns - pixel.t_ns));
      pairs += weight;
      agreeing += weight * event.polarity * pixel.polarity;
      // First events are of one polarity where pixels leak.
      seen += static_cast<double>(threshold(event));
    }
    const auto blind = static_cast<double>(blind_change(event, pixel));
    pixel.t_ns = event.t_ns;
    pixel.polarity = event.polarity;
    (blind > 0 ? rises : falls) += std::abs(blind);
  }
  const double correlation = pairs > 0 ? std::max(0.0, agreeing / pairs) : 0;
  const double share = correlation * correlation;
  rises *= share;
  falls *= share;
  if (!(rises > 0 && falls > 0)) return;
  // seen + w rises - falls / w = 0.
  const double w = (std::sqrt(seen * seen + 4 * rises * falls) - seen) / (2 * rises);
  const double balanced = std::clamp(w, 1 / kMostWeight, kMostWeight);
  rise_weight_ = static_cast<float>(share * balanced);
  fall_weight_ = static_cast<float>(share / balanced);
}

}  // namespace saccade
