#include "simulator/sensor/adaptive/audit.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/random.h"

namespace saccade {
namespace {

/// Audited tiles of which some miss many events at once.
struct GroupedMisses {
  std::size_t tiles;
  std::uint64_t events;  ///< of a tile
  std::uint64_t group;   ///< missed at once
  double probability;    ///< of such a group in a tile

  [[nodiscard]] double recall() const {
    return 1 - probability * static_cast<double>(group) / static_cast<double>(events);
  }
  [[nodiscard]] std::vector<AuditedCounts> draw(std::uint64_t seed) const {
    const Random random(seed);
    std::vector<AuditedCounts> counts(tiles);
    for (std::size_t i = 0; i < tiles; ++i) {
      const bool misses = random.uniform(i, 0) < probability;
      counts[i].pixels = 16;
      counts[i].counts.exact = events;
      counts[i].counts.sampled = misses ? events - group : events;
      for (std::uint64_t& matched : counts[i].counts.matched) matched = counts[i].counts.sampled;
    }
    return counts;
  }
};

TEST(Audit, ItsIntervalsHoldWhereMissesAreRareAndComeInGroups) {
  // As on Desk: 27 tiles, more than half of the audits see no miss at all.
  const GroupedMisses world{27, 32, 18, 0.015};
  constexpr std::uint64_t kAudits = 200;
  std::uint64_t held = 0;
  for (std::uint64_t seed = 0; seed < kAudits; ++seed) {
    const AuditResult result = audit_result(world.draw(seed), seed);
    if (result.recall_10us.low <= world.recall() && world.recall() <= result.recall_10us.high)
      ++held;
    EXPECT_EQ(result.precision_10us.value, 1);
  }
  // 95 % less three of its standard deviations.
  EXPECT_GE(held, kAudits * 90 / 100);
}

TEST(Audit, OfManyTilesTheIntervalIsNarrow) {
  const GroupedMisses world{2700, 32, 18, 0.015};
  const AuditResult result = audit_result(world.draw(7), 7);
  EXPECT_NEAR(result.recall_10us.value, world.recall(), 0.005);
  EXPECT_LT(result.recall_10us.high - result.recall_10us.low, 0.01);
  EXPECT_GT(result.recall_10us.high, world.recall());
  EXPECT_LT(result.recall_10us.low, world.recall());
}

}  // namespace
}  // namespace saccade
