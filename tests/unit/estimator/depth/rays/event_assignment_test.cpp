#include "estimator/depth/rays/event_assignment.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

FittedEdgel edge_at(float inverse_depth, float support, std::uint32_t first, std::uint32_t last) {
  return {{{0, 0}, {1, 0}, inverse_depth}, 1e-4F, 0.5F, support, first, last};
}

TEST(EventAssignment, DropsAnEdgelMadeOfAnothersEvents) {
  // The first explains events 0-9 well; the second has 6 of them and 2 of its own.
  EdgelEvents events;
  for (std::uint32_t i = 0; i < 10; ++i) events.event.push_back(i);
  for (const std::uint32_t i : {0U, 1U, 2U, 3U, 4U, 5U, 10U, 11U}) events.event.push_back(i);
  events.weight.assign(events.event.size(), 1.F);
  const auto kept =
      assign_events({edge_at(0.5F, 10, 0, 10), edge_at(0.9F, 8, 10, 18)}, events, 12, 0.9);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].edge.inverse_depth, 0.5F);
}

TEST(EventAssignment, NeighboursAtOneDepthShareEvents) {
  EdgelEvents events;
  for (int k = 0; k < 2; ++k)
    for (std::uint32_t i = 0; i < 10; ++i) events.event.push_back(i);
  events.weight.assign(20, 1.F);
  const FittedEdgel first = edge_at(0.5F, 10, 0, 10);
  EXPECT_EQ(assign_events({first, edge_at(0.501F, 9, 10, 20)}, events, 10, 0.9).size(), 2U);
  EXPECT_EQ(assign_events({first, edge_at(0.53F, 9, 10, 20)}, events, 10, 0.8).size(), 1U);
}

}  // namespace
}  // namespace saccade
