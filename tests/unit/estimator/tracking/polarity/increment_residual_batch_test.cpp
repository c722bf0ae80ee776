#include "estimator/tracking/polarity/increment_residual_batch.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Cholesky>

#include "core/random.h"
#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::central_differences;
using testing::small_uneven_camera;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

constexpr double kGain = 0.7;
constexpr float kIncrementSigma = 0.5F;

/// Increments M(u) = a x + b y + c: bilinear sampling is exact.
constexpr double kSlopeX = 0.06, kSlopeY = -0.04, kOffset = 0.3;
double increment_at(const Eigen::Vector2d& pixel) {
  return kSlopeX * pixel.x() + kSlopeY * pixel.y() + kOffset;
}

void add_point(IncrementPoints& points, const Eigen::Vector2d& pixel, double depth_m) {
  const PinholeCamera camera = small_uneven_camera();
  const Eigen::Vector3d ray = camera.ray(pixel);
  const Twist row =
      (Eigen::RowVector2d(kSlopeX, kSlopeY) * interaction_matrix(camera, ray, depth_m)).transpose();
  const std::size_t i = points.count++;
  points.ray_x[i] = static_cast<float>(ray.x());
  points.ray_y[i] = static_cast<float>(ray.y());
  points.inverse_depth[i] = static_cast<float>(1 / depth_m);
  points.increment[i] = static_cast<float>(increment_at(pixel));
  points.slope[i] = static_cast<float>(std::hypot(kSlopeX, kSlopeY));
  for (std::size_t c = 0; c < 6; ++c)
    points.by_pose[c][i] = static_cast<float>(row(static_cast<Eigen::Index>(c)));
}

IncrementPoints some_points(std::size_t count) {
  const Random random(2);
  IncrementPoints points(count);
  for (std::uint64_t i = 0; i < count; ++i)
    add_point(points, {5 + 50 * random.uniform(0, i), 5 + 35 * random.uniform(1, i)},
              1 + 2 * random.uniform(2, i));
  return points;
}

/// What fires exactly as expected, and `excess` more everywhere.
ImageF frame_of(double excess = 0) {
  ImageF frame(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      frame(x, y) = static_cast<float>(kGain * increment_at({x, y}) + excess);
  return frame;
}

IncrementResidualBatch::Sums sums_of(const IncrementPoints& points, const ImageF& frame,
                                     const Rigid3& current_from_template, double gain = kGain,
                                     float sigma = kIncrementSigma,
                                     float position_sigma_px = 0.2F) {
  IncrementResidualBatch batch;
  IncrementResidualBatch::Sums sums;
  for (std::size_t first = 0; first < points.count; first += IncrementResidualBatch::kCapacity) {
    batch.evaluate(small_uneven_camera(), frame, points, first, current_from_template, gain, sigma,
                   position_sigma_px);
    batch.add_to(sums);
  }
  return sums;
}

TEST(IncrementResidualBatch, JacobianIsThatOfTheResidual) {
  // Where the frame is what the template expects the residual rises by what the template would
  // rise by if its points moved, and falls with the gain.
  const ImageF frame = frame_of(0.3);
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(7, 9), {50, 12}, {31, 24}, {12, 40}})
    for (const double depth : {0.7, 3.0}) {
      IncrementPoints points(1);
      add_point(points, pixel, depth);
      const auto residual = [&](const Vector7& change) {
        const IncrementResidualBatch::Sums sums =
            sums_of(points, frame, Rigid3::exp(change.head<6>()), kGain + change(6));
        return Eigen::Matrix<double, 1, 1>(std::sqrt(sums.squares / sums.weight));
      };
      Vector7 numeric =
          central_differences<1, 7>(residual, Vector7(Vector7::Zero()), 1e-3).transpose();
      numeric(6) = -numeric(6);
      const IncrementResidualBatch::Sums sums = sums_of(points, frame, Rigid3());
      const double weight = sums.normal(6, 6) / std::pow(increment_at(pixel), 2);
      const Vector7 row = sums.rhs / (weight * 0.3);
      EXPECT_LT((row - numeric).cwiseAbs().maxCoeff(), 3e-3 * numeric.cwiseAbs().maxCoeff())
          << row.transpose() << "\nnumeric " << numeric.transpose();
      const Matrix7 squared = sums.normal.selfadjointView<Eigen::Upper>();
      EXPECT_LT((squared / weight - row * row.transpose()).cwiseAbs().maxCoeff(),
                1e-3 * row.squaredNorm());
    }
}

TEST(IncrementResidualBatch, WeightsAreCauchysWithinWhatIsExpected) {
  IncrementPoints points(1);
  add_point(points, {20, 30}, 2);
  for (const double excess : {-2.0, 0.4, 1.0}) {
    const IncrementResidualBatch::Sums sums = sums_of(points, frame_of(excess), Rigid3());
    const double place = 0.2 * kGain * std::hypot(kSlopeX, kSlopeY);
    const double variance = 0.25 + place * place;
    const double cauchy = 1 / (1 + excess * excess / (2.4 * 2.4 * variance));
    EXPECT_NEAR(sums.weight, cauchy, 1e-4);
    EXPECT_NEAR(sums.squares, cauchy * excess * excess, 1e-4);
    EXPECT_NEAR(sums.normal(6, 6), cauchy * 0.25 / variance * std::pow(increment_at({20, 30}), 2),
                1e-4);
  }
}

TEST(IncrementResidualBatch, PointsOutsideOfTheFrameWeighNothing) {
  const IncrementPoints points = some_points(100);
  const IncrementResidualBatch::Sums behind =
      sums_of(points, frame_of(), Rigid3({1, 0, 0, 0}, {0, 0, -5}));
  EXPECT_EQ(behind.visible, 0);
  EXPECT_EQ(behind.weight, 0);
  EXPECT_EQ(behind.normal, Matrix7(Matrix7::Zero()));
  const IncrementResidualBatch::Sums beside =
      sums_of(points, frame_of(), Rigid3({1, 0, 0, 0}, {1, 0, 0}));
  EXPECT_GT(beside.visible, 0);
  EXPECT_LT(beside.visible, 80);
}

TEST(IncrementResidualBatch, LanesBehindTheLastPointWeighNothing) {
  IncrementPoints all = some_points(600);
  for (const std::size_t count : {1U, 15U, 16U, 17U, 257U, 300U}) {
    IncrementPoints few = all;
    few.count = count;
    EXPECT_EQ(sums_of(few, frame_of(0.2), Rigid3()).visible, static_cast<double>(count));
    // Neither does what stands behind it.
    const Matrix7 normal = sums_of(few, frame_of(0.2), Rigid3()).normal;
    for (std::size_t i = count; i < 600; ++i) few.by_pose[0][i] = 1e6F;
    EXPECT_EQ(sums_of(few, frame_of(0.2), Rigid3()).normal, normal);
  }
}

TEST(IncrementResidualBatch, TheGainIsEliminated) {
  const IncrementPoints points = some_points(600);
  // All slopes are alike: a prior makes the pose determined.
  IncrementResidualBatch::Sums sums = sums_of(points, frame_of(0.2), Rigid3());
  Matrix7 joint = sums.normal.selfadjointView<Eigen::Upper>();
  joint.diagonal().head<6>().array() += 1;
  const Vector7 together = joint.llt().solve(sums.rhs);
  PoseEquations alone = sums.of_pose();
  Matrix6 normal = alone.normal.selfadjointView<Eigen::Upper>();
  normal.diagonal().array() += 1;
  const Vector6 step = normal.llt().solve(alone.rhs);
  EXPECT_LT((step - together.head<6>()).norm(), 1e-6 * (1 + step.norm()));
}

TEST(IncrementResidualBatch, AgreementCountsSigns) {
  const IncrementPoints points = some_points(300);
  EXPECT_NEAR(sums_of(points, frame_of(), Rigid3()).agreement(), 1, 1e-6);
  ImageF opposite = frame_of();
  for (float& value : opposite.pixels()) value = -value;
  EXPECT_NEAR(sums_of(points, opposite, Rigid3()).agreement(), 0, 1e-6);
  const Random random(5);
  for (std::uint64_t i = 0; i < opposite.size(); ++i)
    opposite.pixels()[i] = random.uniform(0, i) < 0.5 ? 1.0F : -1.0F;
  EXPECT_NEAR(sums_of(points, opposite, Rigid3()).agreement(), 0.5, 0.1);
  EXPECT_EQ(IncrementResidualBatch::Sums().agreement(), 0);
}

}  // namespace
}  // namespace saccade
