#include "estimator/edges/edge_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace saccade {
namespace {

const PinholeCamera kViewCamera{64, 48, 50, 50, 31.5, 23.5, {}};

/// One pixel fires every millisecond, by turns three ON and three OFF events.
Events runs_of_three(int count) {
  Events events;
  for (int i = 0; i < count; ++i)
    events.push_back(
        {(i + 1) * TimeNs{1'000'000}, 20, 10, static_cast<std::int8_t>(i / 3 % 2 == 0 ? 1 : -1)});
  return events;
}

class ViewOfEdges : public ::testing::Test {
 protected:
  /// The first edge has the events from `first` on, latest first, the second has none.
  EdgeView view(std::uint32_t first, const EdgeViewOptions& options,
                const PinholeCamera& camera = kViewCamera) {
    WindowEdgels found;
    for (auto e = static_cast<std::uint32_t>(events_.size()); e-- > first;) {
      found.events.event.push_back(e);
      found.events.weight.push_back(1);
    }
    const auto all = static_cast<std::uint32_t>(found.events.event.size());
    FittedEdgel edge;
    edge.first = 0;
    edge.last = all;
    found.edges.push_back(edge);
    edge.first = all;
    found.edges.push_back(edge);
    return edge_view({events_, &path_, 0.03}, found, camera, options);
  }

  Events events_ = runs_of_three(60);
  Trajectory path_{{{0, Rigid3()}, {1, Rigid3()}}};
};

TEST_F(ViewOfEdges, HasEventsEvenlyInTime) {
  const EdgeView found = view(0, {.events_per_edge = 6, .given_events_per_edge = 0});
  EXPECT_EQ(found.t_s, 0.03);
  EXPECT_DOUBLE_EQ(found.from_s, 0.001);
  EXPECT_DOUBLE_EQ(found.until_s, 0.06);
  ASSERT_EQ(found.edges.size(), 2U);
  const auto events = found.of(found.edges[0]);
  ASSERT_EQ(events.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(events[i].t_s, 0.001 + 0.01 * static_cast<double>(i), 1e-12);
  EXPECT_TRUE(found.of(found.edges[1]).empty());
}

TEST_F(ViewOfEdges, ThoseOfGivenPosesAreCountedApart) {
  const EdgeView found =
      view(0, {.events_per_edge = 4, .given_events_per_edge = 7, .given_until_s = 0.0205});
  const auto events = found.of(found.edges[0]);
  const auto given = std::count_if(events.begin(), events.end(),
                                   [](const EdgeEvent& event) { return event.t_s < 0.0205; });
  EXPECT_EQ(given, 7);
  EXPECT_EQ(events.size(), 11U);
}

TEST_F(ViewOfEdges, AnEventSaysWhereInItsRunItIs) {
  // Whole runs: the mean position is 2. Of the pixel's first run nothing is known.
  const EdgeView found = view(3, {.events_per_edge = 100});
  const auto events = found.of(found.edges[0]);
  ASSERT_EQ(events.size(), 57U);
  for (std::size_t i = 0; i < events.size(); ++i) {
    const float polarity = i / 3 % 2 == 0 ? -1 : 1;
    EXPECT_EQ(events[i].polarity, polarity);
    EXPECT_FLOAT_EQ(events[i].run_offset, polarity * (static_cast<float>(i % 3) - 1)) << i;
  }
  const EdgeView all = view(0, {.events_per_edge = 100});
  for (const EdgeEvent& event : all.of(all.edges[0]).first(3)) EXPECT_EQ(event.run_offset, 0);
}

TEST_F(ViewOfEdges, RaysAreThoseBehindTheLens) {
  PinholeCamera lens = kViewCamera;
  lens.distortion[0] = -0.2;
  const EdgeEvent plain = view(0, {}).events.front(), bent = view(0, {}, lens).events.front();
  const Eigen::Vector3d expected = kViewCamera.ray({20, 10});
  EXPECT_FLOAT_EQ(plain.ray_x, static_cast<float>(expected.x()));
  EXPECT_FLOAT_EQ(plain.ray_y, static_cast<float>(expected.y()));
  EXPECT_GT(std::abs(bent.ray_x - plain.ray_x), 1e-3F);
  const Eigen::Vector2d back =
      lens.distort(kViewCamera.project(Eigen::Vector3d(bent.ray_x, bent.ray_y, 1)));
  EXPECT_LT((back - Eigen::Vector2d(20, 10)).norm(), 1e-2);
}

TEST(Evenly, TakesIndicesAtEqualSteps) {
  EXPECT_EQ(evenly(10, 5), (std::vector<std::size_t>{0, 2, 4, 6, 8}));
  EXPECT_EQ(evenly(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(evenly(0, 5).empty());
  EXPECT_TRUE(evenly(5, 0).empty());
}

}  // namespace
}  // namespace saccade
