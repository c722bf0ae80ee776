#include "estimator/imu/velocity_chain.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "core/random.h"

namespace saccade {
namespace {

constexpr int kHead = VelocityChain::kHead;
constexpr int kSkipped = 3;  ///< the link of which nothing is known

using Chain = VelocityChain;

Chain::Rows random_rows(std::uint64_t link) {
  const Random random(5);
  std::uint64_t index = 0;
  const auto draw = [&] { return random.normal(link, index++); };
  Chain::Rows rows;
  for (double& value : rows.head.reshaped()) value = draw();
  for (double& value : rows.value) value = draw();
  for (double& value : rows.weight) value = 0.5 + std::abs(draw());
  rows.duration_s = 0.1 + 0.05 * std::abs(draw());
  return rows;
}

/// The same equations in one matrix over (v_0 ... v_n, head), each divided by its deviation.
struct Dense {
  Eigen::MatrixXd rows;
  Eigen::VectorXd values;

  Dense(int links, const Chain::Head& precision)
      : rows(Eigen::MatrixXd::Zero(6 * links + 3 * (links + 1) + kHead, 3 * (links + 1) + kHead)),
        values(Eigen::VectorXd::Zero(rows.rows())) {
    // What holds the velocities and the head near zero.
    const Eigen::Index velocities = 3 * (links + 1), first = 6 * links;
    rows.block(first, 0, velocities, velocities).diagonal().setConstant(std::sqrt(1e-9));
    rows.bottomRightCorner<kHead, kHead>().diagonal() = precision.cwiseSqrt();
  }

  void set(int link, const Chain::Rows& of) {
    const Eigen::Index row = 6 * link, column = 3 * link;
    rows.block<3, 3>(row, column) = of.duration_s * Eigen::Matrix3d::Identity();
    rows.block<3, 3>(row + 3, column).setIdentity();
    rows.block<3, 3>(row + 3, column + 3) = -Eigen::Matrix3d::Identity();
    rows.block<6, kHead>(row, rows.cols() - kHead) = of.head;
    rows.middleRows<6>(row) = (of.weight.asDiagonal() * rows.middleRows<6>(row)).eval();
    values.segment<6>(row) = of.weight.cwiseProduct(of.value);
  }
};

TEST(VelocityChain, SolvesAsOneDenseLeastSquares) {
  constexpr int kLinks = 9;
  const Chain::Head precision{{0.3, 0, 2, 0.1, 0, 1}};
  Chain chain(precision);
  Dense dense(kLinks, precision);
  for (int link = 0; link < kLinks; ++link) {
    if (link == kSkipped) {
      chain.skip();
      continue;
    }
    const Chain::Rows rows = random_rows(static_cast<std::uint64_t>(link));
    chain.add(rows);
    dense.set(link, rows);
  }
  const Chain::Solution solution = chain.solve();
  const Eigen::VectorXd expected = dense.rows.colPivHouseholderQr().solve(dense.values);
  ASSERT_EQ(solution.velocities.size(), std::size_t{kLinks + 1});
  for (int j = 0; j <= kLinks; ++j)
    EXPECT_LT(
        (solution.velocities[static_cast<std::size_t>(j)] - expected.segment<3>(3 * j)).norm(),
        1e-9)
        << "velocity " << j;
  EXPECT_LT((solution.head - expected.tail<kHead>()).norm(), 1e-9);
  const Eigen::MatrixXd covariance = (dense.rows.transpose() * dense.rows).inverse();
  EXPECT_LT((solution.covariance - covariance.bottomRightCorner<kHead, kHead>()).norm(), 1e-9);
}

TEST(VelocityChain, WithoutALinkIsWhatIsKnownBefore) {
  const Chain::Head precision = Chain::Head::Constant(4);
  const Chain::Solution solution = Chain(precision).solve();
  EXPECT_EQ(solution.velocities.size(), 1U);
  EXPECT_EQ(solution.head.norm(), 0);
  EXPECT_LT((solution.covariance.diagonal() - Chain::Head::Constant(0.25)).norm(), 1e-12);
}

}  // namespace
}  // namespace saccade
