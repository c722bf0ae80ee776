#include "estimator/tracking/edges/sample_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/tracking/edges/synthetic_template.h"

namespace saccade {
namespace {

using testing::expect_jacobian;
using testing::small_camera;

TemplatePoint random_point(std::uint64_t index) {
  const Random random(17);
  TemplatePoint p;
  p.ray = {static_cast<float>(random.uniform(0, index) - 0.5),
           static_cast<float>(random.uniform(1, index) - 0.5)};
  p.inverse_depth = static_cast<float>(0.3 + random.uniform(2, index));
  p.value = static_cast<float>(random.uniform(3, index));
  p.slope = {static_cast<float>(10 * random.normal(4, index)),
             static_cast<float>(10 * random.normal(5, index))};
  return p;
}

/// J of one template point, as the normal equations get it.
Eigen::Matrix<double, 1, 6> jacobian_of(const TemplatePoint& point) {
  SampleBatch batch;
  batch.load(std::span(&point, 1), 0, 1, 1, 0);
  batch.show_all();
  batch.differentiate();
  Eigen::Matrix<double, 1, 6> jacobian;
  for (int c = 0; c < 6; ++c) jacobian(c) = batch.column_dot_column(c, 7);
  return jacobian;
}

TEST(SampleBatch, JacobianIsTheDerivativeOfTheWarpedTemplate) {
  for (std::uint64_t i = 0; i < 20; ++i) {
    const TemplatePoint p = random_point(i);
    const Eigen::Vector3d point =
        Eigen::Vector3d(p.ray.x(), p.ray.y(), 1) / static_cast<double>(p.inverse_depth);
    // To first order T changes by slope times the way of the ray: dT/dxi at xi = 0 (4.15).
    const auto value = [&](const Twist& xi) {
      const Eigen::Vector3d moved = Rigid3::exp(xi) * point;
      return Eigen::Matrix<double, 1, 1>(p.slope.cast<double>().dot(moved.hnormalized()));
    };
    expect_jacobian<1, 6>(jacobian_of(p), value, Twist::Zero(), 2e-6);
  }
}

TEST(SampleBatch, JacobianIsGradientTimesInteractionMatrix) {
  const PinholeCamera camera = small_camera();
  for (std::uint64_t i = 0; i < 20; ++i) {
    const TemplatePoint p = random_point(i);
    const Eigen::RowVector2d gradient(p.slope.x() / camera.fx, p.slope.y() / camera.fy);
    const Eigen::Matrix<double, 1, 6> expected =
        gradient * interaction_matrix(camera, {p.ray.x(), p.ray.y(), 1},
                                      1 / static_cast<double>(p.inverse_depth));
    EXPECT_LT((jacobian_of(p) - expected).norm(), 2e-6 * (1 + expected.norm()));
  }
}

TEST(SampleBatch, AsManySamplesAsPointsTakeEachOnce) {
  std::vector<TemplatePoint> points(200);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = random_point(i);
    points[i].value = 1 + static_cast<float>(i);
  }
  SampleBatch batch;
  batch.load(points, 0, 200, 200, 12345);
  batch.show_all();
  batch.differentiate();
  EXPECT_NEAR(batch.column_dot_column(6, 7), 200 * 201 / 2, 1e-2);
  EXPECT_NEAR(batch.column_dot_column(6, 6) / (200.0 * 201 * 401 / 6), 1, 1e-5);
}

TEST(SampleBatch, LoadAllTakesEachPointOnce) {
  std::vector<TemplatePoint> points(77);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = random_point(i);
    points[i].value = 1 + static_cast<float>(i);
  }
  SampleBatch batch;
  batch.load_all(points);
  batch.show_all();
  batch.differentiate();
  EXPECT_NEAR(batch.column_dot_column(6, 7), 77 * 78 / 2, 1e-2);
  EXPECT_NEAR(batch.column_dot_column(6, 6) / (77.0 * 78 * 155 / 6), 1, 1e-5);
}

TEST(SampleBatch, SamplesAreUniformOverThePoints) {
  // 50 of 1000 points, drawn 2000 times: every point about 100 times. The count of one is binomial
  // with sigma 10; the largest of 1000 stays below 5 sigma.
  std::vector<TemplatePoint> points(1000);
  std::vector<double> hits(1000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = random_point(i);
    points[i].value = 0;
  }
  const Random random(1);
  for (std::size_t probe = 0; probe < points.size(); probe += 37) {
    points[probe].value = 1;
    SampleBatch batch;
    for (std::uint64_t draw = 0; draw < 2000; ++draw) {
      batch.load(points, 0, 50, 50, random.bits(draw, 0)[0]);
      batch.show_all();
      batch.differentiate();
      hits[probe] += batch.column_dot_column(6, 7);
    }
    points[probe].value = 0;
    EXPECT_NEAR(hits[probe], 100, 50) << probe;
  }
}

/// Template points on a row of small_camera() at 2 m.
std::vector<TemplatePoint> row_of_points(double x0, int count, double y) {
  std::vector<TemplatePoint> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d ray = small_camera().ray({x0 + i, y});
    points.push_back({ray.head<2>().cast<float>(), 0.5F, 1, {1, 0}});
  }
  return points;
}

TEST(SampleBatch, ReadsTheFrameWhereTheWarpSays) {
  // An event at (50, 40); points around it, moved by 0.25 px to the right.
  EventFrame frame(small_camera());
  frame.draw(Events{{0, 50, 40, 1}});
  const Rigid3 shift({1, 0, 0, 0}, {0.25 * 2 / small_camera().fx, 0, 0});
  const std::vector<double> expected{0, 0.25, 0.75, 0};  // columns 48.25, 49.25, 50.25, 51.25
  const auto points = row_of_points(48, 4, 40);
  for (std::size_t i = 0; i < points.size(); ++i) {
    SampleBatch batch;
    batch.load(std::span(points).subspan(i, 1), 0, 1, 1, 0);
    batch.warp(small_camera(), frame, shift);
    batch.compare(frame, false, 0.5F, 0.125F);
    EXPECT_EQ(batch.visible(), 1);
    const double residual = expected[i] - 0.5 - 0.125;  // I - gain T - offset
    EXPECT_NEAR(batch.squared_residual(), residual * residual, 1e-4) << i;
    batch.differentiate();
    EXPECT_NEAR(batch.columns_dot_residual()[7], residual, 1e-4) << i;
  }
}

TEST(RobustLoss, FollowsItsDefinition) {
  for (float x = -8; x <= 8; x += 0.25F) {
    const double a = std::abs(static_cast<double>(x));
    const auto squared = [x](RobustLoss kind) {
      return std::pow(static_cast<double>(sqrt_weight(kind, x)), 2);
    };
    EXPECT_EQ(squared(RobustLoss::kNone), 1);
    EXPECT_NEAR(squared(RobustLoss::kHuber), a <= 1.345 ? 1 : 1.345 / a, 1e-6);
    const double tukey = a < 4.685 ? std::pow(1 - std::pow(a / 4.685, 2), 2) : 0;
    EXPECT_NEAR(squared(RobustLoss::kTukey), tukey, 1e-6);
  }
}

TEST(SampleBatch, WeighingScalesEverySumByTheWeights) {
  // Residuals 1 (an event where none is expected) and 0: at a sigma of 0.25 the first is an
  // outlier.
  EventFrame frame(small_camera());
  frame.draw(Events{{0, 50, 40, 1}});
  auto points = row_of_points(50, 3, 40);
  for (TemplatePoint& p : points) {
    p.value = 0;
    p.ray.y() += 1e-5F;  // not on the seam between two rows
  }
  const Rigid3 shift({1, 0, 0, 0}, {1e-5, 0, 0});
  for (const RobustLoss kind : {RobustLoss::kHuber, RobustLoss::kTukey}) {
    SampleBatch batch;
    batch.load_all(points);
    batch.warp(small_camera(), frame, shift);
    batch.compare(frame, false, 0, 0);
    EXPECT_NEAR(batch.visible(), 3, 1e-6);
    batch.weigh(kind, 0.25F);
    batch.differentiate();
    const double outlier = std::pow(static_cast<double>(sqrt_weight(kind, 4)), 2);
    EXPECT_LT(outlier, 0.5);
    EXPECT_NEAR(batch.visible(), 2 + outlier, 5e-3);
    EXPECT_NEAR(batch.column_dot_column(7, 7), 2 + outlier, 5e-3);
    EXPECT_NEAR(batch.columns_dot_residual()[7], outlier, 5e-3);
  }
}

TEST(SampleBatch, SmoothReadsTheMeanOfThreeByThreePixels) {
  EventFrame frame(small_camera());
  frame.draw(Events{{0, 50, 40, 1}, {0, 51, 41, 1}});
  const auto read = [&](double x, double y) {
    const auto points = row_of_points(x, 1, y);
    SampleBatch batch;
    batch.load(points, 0, 1, 1, 0);
    batch.warp(small_camera(), frame, Rigid3{});
    batch.compare(frame, true, 0, 0);
    batch.differentiate();
    return batch.columns_dot_residual()[7];
  };
  EXPECT_NEAR(read(50, 40), 2.0 / 9, 1e-4);
  EXPECT_NEAR(read(49, 39), 1.0 / 9, 1e-4);
  EXPECT_NEAR(read(48.5, 40), 0.5 / 9, 1e-3);
  EXPECT_NEAR(read(52.25, 41.5), 0.75 / 9, 1e-3);
  EXPECT_NEAR(read(53.5, 40), 0, 1e-4);
}

TEST(SampleBatch, SmoothReadsStayInsideTheMemoryOfTheFrame) {
  EventFrame frame(small_camera());
  Events corners;
  for (const int x : {0, small_camera().width - 1})
    for (const int y : {0, small_camera().height - 1})
      corners.push_back({0, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1});
  frame.draw(corners);
  for (const double x : {0.0, small_camera().width - 1.001})
    for (const double y : {0.0, small_camera().height - 1.001}) {
      const auto points = row_of_points(x, 1, y);
      SampleBatch batch;
      batch.load(points, 0, 1, 1, 0);
      batch.warp(small_camera(), frame, Rigid3{});
      batch.compare(frame, true, 0, 0);
      batch.differentiate();
      EXPECT_NEAR(batch.columns_dot_residual()[7], 1.0 / 9, 2e-3) << x << ", " << y;
    }
}

TEST(SampleBatch, BothWaysToTheColumnsAgree) {
  const auto points = row_of_points(60, 40, 50);
  const EventFrame empty(small_camera());
  SampleBatch batch;
  batch.load(points, 0, 40, 40, 0);
  batch.warp(small_camera(), empty, {});
  batch.compare(empty, false, 0, -1);  // a residual of one everywhere
  batch.differentiate();
  for (std::size_t c = 0; c < SampleBatch::kColumns; ++c)
    EXPECT_NEAR(batch.columns_dot_residual()[c],
                batch.column_dot_column(static_cast<int>(c), SampleBatch::kColumns - 1), 1e-4)
        << c;
}

TEST(SampleBatch, SamplesOutsideTheFrameCountForNothing) {
  EventFrame frame(small_camera());
  for (const Rigid3& away :
       {Rigid3({1, 0, 0, 0}, {100, 0, 0}), Rigid3({1, 0, 0, 0}, {0, -100, 0}),
        Rigid3({1, 0, 0, 0}, {0, 0, -5}), Rigid3(so3_exp({0, 3, 0}), {0, 0, 0}),
        Rigid3({1, 0, 0, 0}, {0, 0, -2})}) {
    const auto points = row_of_points(60, 40, 50);
    SampleBatch batch;
    batch.load(points, 0, 40, 40, 0);
    batch.warp(small_camera(), frame, away);
    batch.compare(frame, false, 1, 0);
    batch.differentiate();
    EXPECT_EQ(batch.visible(), 0);
    EXPECT_EQ(batch.squared_residual(), 0);
    EXPECT_EQ(batch.agreeing(0.5F, 0.5F), 0);
    for (int c = 0; c < SampleBatch::kColumns; ++c) {
      EXPECT_EQ(batch.columns_dot_residual()[static_cast<std::size_t>(c)], 0);
      EXPECT_EQ(batch.column_dot_column(c, c), 0);
    }
  }
}

TEST(SampleBatch, AgreementCountsSamplesOnTheSameSideOfTheMeans) {
  EventFrame frame(small_camera());
  frame.draw(Events{{0, 60, 50, 1}, {0, 61, 50, 1}});
  auto points = row_of_points(60, 4, 50);
  for (TemplatePoint& p : points) p.ray.y() += 1e-5F;  // not on the seam between two rows
  points[1].value = 0;                                 // full frame, dark template
  points[3].value = 0;                                 // dark both
  SampleBatch batch;
  batch.load(points, 0, 4, 4, 0);
  batch.warp(small_camera(), frame, Rigid3({1, 0, 0, 0}, {1e-4, 0, 0}));
  batch.compare(frame, false, 1, 0);
  EXPECT_EQ(batch.agreeing(0.5F, 0.5F), 2);
}

}  // namespace
}  // namespace saccade
