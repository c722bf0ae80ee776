#include "estimator/edges/least_squares/edge_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::uneven_camera;

const Eigen::Vector2d kPixel(165, 62), kNormal(0.8, 0.6);

BundleEvent<4> some_event(std::uint64_t index) {
  const Random random(3);
  const auto part = [&](std::uint64_t k) { return random.uniform(index, k) - 0.5; };
  BundleEvent<4> event;
  event.observation.view_from_camera =
      Rigid3::exp((Twist() << 0.2 * part(0), 0.2 * part(1), 0.2 * part(2), 0.1 * part(3),
                   0.1 * part(4), 0.1 * part(5))
                      .finished());
  event.observation.ray = {0.21 + 0.02 * part(6), -0.13 + 0.02 * part(7), 1};
  event.observation.lag = index % 2 == 0 ? 1 : -1;
  event.observation.pixel = kPixel;
  event.observation.normal = kNormal;
  event.run_offset = part(8);
  event.sigma_px = 0.1 + 0.2 * random.uniform(index, 9);
  event.first = index % 3;
  event.weight = Eigen::Vector4d(0.1, 0.5, 0.35, 0.05);
  return event;
}

/// As many unknowns of a path, of turns to tens of degrees.
std::vector<double> some_path(std::size_t twists) {
  std::vector<double> path(6 * twists);
  for (std::size_t i = 0; i < path.size(); ++i)
    path[i] = 0.3 * std::sin(1.3 * static_cast<double>(i));
  return path;
}

Twist twist_of(const BundleEvent<4>& event, const std::vector<double>& path) {
  Twist twist = Twist::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    twist += event.weight[static_cast<Eigen::Index>(k)] *
             Eigen::Map<const Twist>(&path[6 * (event.first + k)]);
  return twist;
}

const EdgeState<5> kEdge{kPixel, kNormal, {0.4, 0.1, 0.05, 0.2, 0.3}};

/// Of the scalar residual of one event, with the offset that its position in the run makes.
double scalar_residual(const BundleEvent<4>& event, const Twist& twist,
                       const Eigen::Matrix<double, 5, 1>& unknowns, EdgeDerivatives* by) {
  EdgeUnknowns edge = unknowns.head<4>();
  edge[1] += event.run_offset * unknowns[4];
  return edge_residual(event.observation, uneven_camera(), twist, edge, by) / event.sigma_px;
}

TEST(EdgeRows, AreThoseOfTheScalarResidual) {
  const std::vector<double> path = some_path(6);
  EventLanes<4> lanes;
  for (std::size_t lane = 0; lane < kEventLanes; ++lane) lanes.set(lane, some_event(lane));
  RowLanes<5> rows;
  DoubleLanes residuals;
  const auto motion = motion_of(lanes, path);
  ASSERT_TRUE(event_rows(lanes, kEdge, uneven_camera(), motion, rows));
  ASSERT_TRUE(event_residuals(lanes, kEdge, uneven_camera(), motion, residuals));
  for (std::size_t lane = 0; lane < kEventLanes; ++lane) {
    const BundleEvent<4> event = some_event(lane);
    const Twist twist = twist_of(event, path);
    EdgeDerivatives by;
    const double expected = scalar_residual(event, twist, kEdge.unknowns, &by);
    EXPECT_NEAR(residuals[lane], expected, 1e-9 * std::abs(expected));
    EXPECT_NEAR(rows.residual[lane], residuals[lane], 1e-12 * std::abs(expected));
    const double size = by.motion.norm() / event.sigma_px;
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(rows.by_motion[i][lane], by.motion[static_cast<Eigen::Index>(i)] / event.sigma_px,
                  1e-9 * size);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(rows.by_edge[i][lane], by.edge[static_cast<Eigen::Index>(i)] / event.sigma_px,
                  1e-9 * by.edge.norm() / event.sigma_px);
    EXPECT_NEAR(rows.by_edge[4][lane], event.run_offset * by.edge[1] / event.sigma_px, 1e-9);
  }
}

/// By central differences of the lanes themselves, whatever the scalar residual says.
TEST(EdgeRows, HaveTheirDerivatives) {
  EventLanes<4> lanes;
  lanes.set(0, some_event(1));
  const auto residual = [&](const Twist& twist, const Eigen::Matrix<double, 5, 1>& unknowns) {
    std::array<DoubleLanes, 6> motion{};
    for (std::size_t i = 0; i < 6; ++i) motion[i][0] = twist[static_cast<Eigen::Index>(i)];
    DoubleLanes residuals;
    EXPECT_TRUE(event_residuals(lanes, EdgeState<5>{kPixel, kNormal, unknowns}, uneven_camera(),
                                motion, residuals));
    return Eigen::Matrix<double, 1, 1>(residuals[0]);
  };
  const Twist at = (Twist() << 0.02, -0.1, 0.05, 0.2, -0.3, 0.15).finished();
  std::array<DoubleLanes, 6> motion{};
  for (std::size_t i = 0; i < 6; ++i) motion[i][0] = at[static_cast<Eigen::Index>(i)];
  RowLanes<5> rows;
  ASSERT_TRUE(event_rows(lanes, kEdge, uneven_camera(), motion, rows));
  Eigen::Matrix<double, 1, 6> by_motion;
  Eigen::Matrix<double, 1, 5> by_edge;
  for (std::size_t i = 0; i < 6; ++i)
    by_motion[static_cast<Eigen::Index>(i)] = rows.by_motion[i][0];
  for (std::size_t i = 0; i < 5; ++i) by_edge[static_cast<Eigen::Index>(i)] = rows.by_edge[i][0];
  testing::expect_jacobian<1, 6>(
      by_motion, [&](const Twist& twist) { return residual(twist, kEdge.unknowns); }, at);
  testing::expect_jacobian<1, 5>(
      by_edge, [&](const Eigen::Matrix<double, 5, 1>& unknowns) { return residual(at, unknowns); },
      kEdge.unknowns);
}

TEST(EdgeRows, ALaneWithoutAnEventSaysNothing) {
  EventLanes<4> lanes;
  lanes.set(2, some_event(0));
  RowLanes<5> rows;
  ASSERT_TRUE(event_rows(lanes, kEdge, uneven_camera(), motion_of(lanes, some_path(4)), rows));
  EXPECT_NE(rows.residual[2], 0);
  EXPECT_EQ(rows.residual[0], 0);
  EXPECT_EQ(rows.by_motion[3][0], 0);
  EXPECT_EQ(rows.by_edge[0][0], 0);
}

TEST(EdgeRows, ARayThatLeadsAwayIsSaid) {
  BundleEvent<4> away = some_event(0);
  away.observation.view_from_camera = Rigid3::exp((Twist() << 0, 0, 0, 3, 0, 0).finished());
  EventLanes<4> lanes;
  lanes.set(0, some_event(0));
  DoubleLanes residuals;
  const std::array<DoubleLanes, 6> still{};
  EXPECT_TRUE(event_residuals(lanes, kEdge, uneven_camera(), still, residuals));
  lanes.set(5, away);
  EXPECT_FALSE(event_residuals(lanes, kEdge, uneven_camera(), still, residuals));
  // An edge behind the event's camera.
  EventLanes<4> behind;
  BundleEvent<4> event = some_event(0);
  event.observation.view_from_camera = Rigid3(Eigen::Quaterniond::Identity(), {0, 0, 10});
  behind.set(0, event);
  EXPECT_FALSE(event_residuals(behind, kEdge, uneven_camera(), still, residuals));
}

TEST(EdgeRows, AnEventIsUnpackedAsItWasPacked) {
  EventLanes<4> lanes;
  const BundleEvent<4> event = some_event(5);
  lanes.set(3, event);
  const BundleEvent<4> back = lanes.event(3, kPixel, kNormal);
  EXPECT_TRUE((back.observation.view_from_camera.inverse() * event.observation.view_from_camera)
                  .log()
                  .isZero(1e-14));
  EXPECT_EQ(back.observation.lag, event.observation.lag);
  EXPECT_EQ(back.run_offset, event.run_offset);
  EXPECT_DOUBLE_EQ(back.sigma_px, event.sigma_px);
  EXPECT_EQ(back.first, event.first);
  EXPECT_EQ(back.weight, event.weight);
}

}  // namespace
}  // namespace saccade
