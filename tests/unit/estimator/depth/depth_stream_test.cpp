#include "estimator/depth/depth_stream.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace saccade {
namespace {

/// Returns one point that tells how many events the window held.
class Counter : public DepthEstimator {
 public:
  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const override {
    DepthResult result;
    result.points.push_back({static_cast<float>(window.events.size()), 0, 1, 1});
    return result;
  }
};

using Views = std::vector<std::pair<double, float>>;  ///< time and number of events

Views views_of(std::size_t chunk) {
  Events events;
  for (int i = 0; i < 1000; ++i) events.push_back({i * 1'000'000, 0, 0, 1});
  const Trajectory trajectory({{0, Rigid3()}, {1, Rigid3()}});
  const Counter counter;
  Views views;
  DepthStream stream(counter, 0.3, 0.5, [&](double t_s, const DepthResult& result) {
    views.emplace_back(t_s, result.points.front().x_px);
  });
  for (std::size_t at = 0; at < events.size(); at += chunk)
    stream.push(std::span(events).subspan(at, std::min(chunk, events.size() - at)), trajectory);
  stream.finish(trajectory);
  return views;
}

TEST(DepthStream, GivesTheSameViewsHoweverItIsFed) {
  const Views views = views_of(1000);
  ASSERT_EQ(views.size(), 4U);
  EXPECT_NEAR(views[0].first, 0.15, 1e-9);
  EXPECT_NEAR(views[1].first, 0.45, 1e-9);
  EXPECT_EQ(views[0].second, 300);
  EXPECT_EQ(views[3].second, 100);
  EXPECT_EQ(views_of(1), views);
  EXPECT_EQ(views_of(333), views);
}

}  // namespace
}  // namespace saccade
