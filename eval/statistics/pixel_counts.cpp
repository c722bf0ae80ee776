#include "eval/statistics/pixel_counts.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace saccade {
namespace {

constexpr int kBlockPx = 10;
constexpr std::size_t kQuietBlocks = 10;  // one block in so many
constexpr std::size_t kHotCount = 10;
constexpr std::size_t kHotTimes = 5;

template <class Visit>
void for_neighbours(const PixelCounts& counts, int x, int y, const Visit& visit) {
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, counts.on.height() - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, counts.on.width() - 1); ++i)
      if (i != x || j != y) visit(i, j);
}

std::size_t hot_pixels(const PixelCounts& counts) {
  std::size_t hot = 0;
  for (int y = 0; y < counts.on.height(); ++y)
    for (int x = 0; x < counts.on.width(); ++x) {
      if (counts.at(x, y) < kHotCount) continue;
      std::vector<std::size_t> around;
      for_neighbours(counts, x, y, [&](int i, int j) { around.push_back(counts.at(i, j)); });
      if (around.empty()) continue;
      std::nth_element(around.begin(), around.begin() + std::ssize(around) / 2, around.end());
      if (counts.at(x, y) > kHotTimes * (around[around.size() / 2] + 1)) ++hot;
    }
  return hot;
}

}  // namespace

PixelRates pixel_rates(const PixelCounts& counts, double duration_s) {
  PixelRates rates;
  for (int y = 0; y < counts.on.height(); ++y)
    for (int x = 0; x < counts.on.width(); ++x)
      rates.ascending_hz.push_back(static_cast<double>(counts.at(x, y)) / duration_s);
  std::vector<double>& all = rates.ascending_hz;
  std::sort(all.begin(), all.end());
  const auto silent = std::distance(all.begin(), std::upper_bound(all.begin(), all.end(), 0.0));
  rates.silent_fraction = static_cast<double>(silent) / static_cast<double>(all.size());
  rates.hot_pixels = hot_pixels(counts);
  return rates;
}

NoiseSigns quiet_rates(const PixelCounts& counts, double duration_s) {
  struct Block {
    std::size_t on = 0, off = 0;
  };
  std::vector<Block> blocks;
  for (int top = 0; top + kBlockPx <= counts.on.height(); top += kBlockPx)
    for (int left = 0; left + kBlockPx <= counts.on.width(); left += kBlockPx) {
      Block& block = blocks.emplace_back();
      for (int y = top; y < top + kBlockPx; ++y)
        for (int x = left; x < left + kBlockPx; ++x) {
          block.on += counts.on(x, y);
          block.off += counts.off(x, y);
        }
    }
  NoiseSigns noise;
  if (blocks.empty()) return noise;
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const Block& a, const Block& b) { return a.on + a.off < b.on + b.off; });
  blocks.resize(std::max<std::size_t>(1, blocks.size() / kQuietBlocks));
  const double pixel_seconds =
      static_cast<double>(blocks.size()) * kBlockPx * kBlockPx * duration_s;
  for (const Block& block : blocks) {
    noise.quiet_on_hz += static_cast<double>(block.on) / pixel_seconds;
    noise.quiet_off_hz += static_cast<double>(block.off) / pixel_seconds;
  }
  return noise;
}

}  // namespace saccade
