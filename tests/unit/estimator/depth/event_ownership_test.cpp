#include "estimator/depth/event_ownership.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

FittedEdge edge_at(float inverse_depth, float support, std::uint32_t first, std::uint32_t last) {
  return {{{0, 0}, {1, 0}, inverse_depth}, 1e-4F, 0.5F, support, first, last};
}

TEST(EventOwnership, AnEdgeMadeOfAnothersEventsGoes) {
  // The first explains events 0-9 well; the second has 6 of them and 2 of its own.
  EdgeEvents events;
  for (std::uint32_t i = 0; i < 10; ++i) events.event.push_back(i);
  for (const std::uint32_t i : {0U, 1U, 2U, 3U, 4U, 5U, 10U, 11U}) events.event.push_back(i);
  events.weight.assign(events.event.size(), 1.F);
  const auto kept = with_own_events({edge_at(0.5F, 10, 0, 10), edge_at(0.9F, 8, 10, 18)}, events,
                                    12, OwnershipOptions{});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].edge.inverse_depth, 0.5F);
}

TEST(EventOwnership, NeighboursAtOneDepthShare) {
  EdgeEvents events;
  for (int k = 0; k < 2; ++k)
    for (std::uint32_t i = 0; i < 10; ++i) events.event.push_back(i);
  events.weight.assign(20, 1.F);
  const std::vector<FittedEdge> edges = {edge_at(0.5F, 10, 0, 10), edge_at(0.501F, 9, 10, 20)};
  EXPECT_EQ(with_own_events(edges, events, 10, OwnershipOptions{}).size(), 2U);
  EXPECT_EQ(with_own_events(edges, events, 10, OwnershipOptions{0.8, 0}).size(), 1U);
}

}  // namespace
}  // namespace saccade
