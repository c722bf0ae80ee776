#include "eval/calibration/stream_moments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/image.h"

namespace saccade {
namespace {

constexpr double kLeastGap_us = 0.1;

}  // namespace

std::size_t StreamMoments::bin_of(double gap_us) {
  const double bin = std::log10(std::max(gap_us, kLeastGap_us) / kLeastGap_us) * kPerDecade;
  return static_cast<std::size_t>(std::clamp(bin, 0.0, kPerDecade * kDecades - 1.0));
}

/// ln of the gap [us] below which the fraction lies, linear in the logarithm within a bin.
double StreamMoments::log_quantile(const std::vector<double>& gaps, double fraction) {
  double all = 0;
  for (const double count : gaps) all += count;
  double below = 0;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i] > 0 && below + gaps[i] >= fraction * all) {
      const double bin = static_cast<double>(i) + (fraction * all - below) / gaps[i];
      return std::log(kLeastGap_us) + std::numbers::ln10 * bin / kPerDecade;
    }
    below += gaps[i];
  }
  return 0;
}

StreamMoments::StreamMoments(std::span<const Event> events, SensorSize size, double duration_s,
                             double shortest_gap_us) {
  SACCADE_CHECK(duration_s > 0);
  const TimeNs fold_ns = ns_from_seconds(duration_s) / static_cast<TimeNs>(kFolds) + 1;
  const auto fold_of = [&](TimeNs t_ns) {
    return std::clamp<std::size_t>(static_cast<std::size_t>(std::max<TimeNs>(t_ns, 0) / fold_ns), 0,
                                   kFolds - 1);
  };
  const auto block_of = [&](int x, int y) {
    return static_cast<std::size_t>((y * kBlocksDown / size.height) * kBlocksAcross +
                                    x * kBlocksAcross / size.width);
  };
  std::array<Image<double>, kFolds> on, off;
  on.fill(Image<double>(size.width, size.height));
  off.fill(Image<double>(size.width, size.height));
  Image<Event> last(size.width, size.height, Event{.t_ns = -1});
  for (const Event& event : events) {
    const std::size_t fold = fold_of(event.t_ns);
    Cell& cell = cells_[fold][block_of(event.x, event.y)];
    (event.polarity > 0 ? cell.on : cell.off) += 1;
    (event.polarity > 0 ? on : off)[fold](event.x, event.y) += 1;
    Event& before = last(event.x, event.y);
    const double gap_us = static_cast<double>(event.t_ns - before.t_ns) * 1e-3;
    if (before.t_ns >= 0 && gap_us >= shortest_gap_us) {
      (event.polarity == before.polarity ? cell.same : cell.opposite) += 1;
      ++cell.gaps[bin_of(gap_us)];
    }
    before = event;
  }
  for (std::size_t fold = 0; fold < kFolds; ++fold)
    for (const Image<double>* counts : {&on[fold], &off[fold]})
      for (int y = 0; y + 1 < size.height; ++y)
        for (int x = 0; x + 1 < size.width; ++x) {
          Cell& cell = cells_[fold][block_of(x, y)];
          const double here = (*counts)(x, y);
          for (const double there : {(*counts)(x + 1, y), (*counts)(x, y + 1)}) {
            cell.differences += (here - there) * (here - there);
            cell.sums += here + there;
          }
        }
}

Moments StreamMoments::of(const std::function<bool(std::size_t, std::size_t)>& takes) const {
  Cell sum;
  std::vector<double> gaps(sum.gaps.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold)
    for (std::size_t block = 0; block < kBlocks; ++block) {
      if (!takes(fold, block)) continue;
      const Cell& cell = cells_[fold][block];
      sum.on += cell.on;
      sum.off += cell.off;
      sum.same += cell.same;
      sum.opposite += cell.opposite;
      sum.differences += cell.differences;
      sum.sums += cell.sums;
      for (std::size_t i = 0; i < gaps.size(); ++i) gaps[i] += cell.gaps[i];
    }
  // One event more keeps the logarithms of what is empty finite.
  Moments m;
  m[kLogOn] = std::log(sum.on + 1);
  m[kLogOff] = std::log(sum.off + 1);
  m[kGapShort] = log_quantile(gaps, 0.10);
  m[kGapLower] = log_quantile(gaps, 0.25);
  m[kGapMiddle] = log_quantile(gaps, 0.50);
  m[kTurning] = std::log((sum.opposite + 1) / (sum.same + 1));
  m[kRoughness] = std::log((sum.differences + 1) / (sum.sums + 1));
  return m;
}

Moments StreamMoments::all() const {
  return of([](std::size_t, std::size_t) { return true; });
}

}  // namespace saccade
