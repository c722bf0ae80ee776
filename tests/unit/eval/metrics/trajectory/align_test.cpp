#include "eval/metrics/trajectory/align.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace saccade {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Quaterniond about(const Vector3d& axis, double angle) {
  return Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// Pairs whose truth is `s` applied to poses at `positions`, each turned differently.
std::vector<PosePair> transformed(const std::vector<Vector3d>& positions, const Similarity& s) {
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Rigid3 pose(about({1, 0.5, -2}, 0.3 * static_cast<double>(i)), positions[i]);
    pairs.push_back({pose, s * pose});
  }
  return pairs;
}

void expect_same(const Similarity& a, const Similarity& b, double tolerance = 1e-9) {
  EXPECT_NEAR(a.scale, b.scale, tolerance);
  EXPECT_LT((a.rigid.translation() - b.rigid.translation()).norm(), tolerance);
  EXPECT_LT(angle_between(a.rigid.rotation(), b.rigid.rotation()), tolerance);
}

const Similarity kTurnedAndScaled{2.5, Rigid3(about({1, 2, 3}, 2.0), {4, -5, 6})};
const Similarity kTurned{1, kTurnedAndScaled.rigid};
const std::vector<Vector3d> kSpread{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-1, 1, 1}};

TEST(Align, RecoversASimilarityExactly) {
  expect_same(align(transformed(kSpread, kTurnedAndScaled), Alignment::kSim3), kTurnedAndScaled);
  expect_same(align(transformed(kSpread, kTurned), Alignment::kSe3), kTurned);
}

TEST(Align, TheInverseLeadsBack) {
  const Similarity there{2.5, {so3_exp({0.3, -1, 2}), {5, -7, 1}}};
  const Eigen::Vector3d point(1, -2, 3);
  EXPECT_LT((there.inverse() * (there * point) - point).norm(), 1e-12);
  const Rigid3 pose(so3_exp({-1, 0.2, 0.1}), point);
  const Rigid3 back = there.inverse() * (there * pose);
  EXPECT_LT((pose.inverse() * back).log().norm(), 1e-12);
}

TEST(Align, AMetricTellsTheAlignmentByItsFreedoms) {
  for (const Alignment alignment :
       {Alignment::kNone, Alignment::kYaw, Alignment::kSe3, Alignment::kSim3})
    EXPECT_EQ(alignment_of(freedoms_of(alignment)), alignment);
}

TEST(Align, YawRotatesAboutTheVerticalAlone) {
  const Similarity yawed{1, Rigid3(about({0, 0, 1}, 2.0), {4, -5, 6})};
  expect_same(align(transformed(kSpread, yawed), Alignment::kYaw), yawed);
  expect_same(align_positions(transformed(kSpread, yawed), Alignment::kYaw), yawed);
  // A tilt stays: SE(3) takes it away.
  const Similarity tilted{1, Rigid3(about({1, 0, 0}, 0.1), {0, 0, 0})};
  const std::vector<PosePair> pairs = transformed(kSpread, tilted);
  const Similarity found = align(pairs, Alignment::kYaw);
  EXPECT_NEAR((found.rigid.rotation() * Vector3d::UnitZ()).z(), 1, 1e-12);
  double left_m = 0;
  for (const PosePair& pair : pairs)
    left_m += (found * pair.estimated.translation() - pair.truth.translation()).norm();
  EXPECT_GT(left_m, 0.1);
}

TEST(Align, YawOfAStandstillIsThatOfTheOrientations) {
  const Similarity yawed{1, Rigid3(about({0, 0, 1}, -1.2), {0, 0, 0})};
  const std::vector<Vector3d> vertical{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
  expect_same(align(transformed(vertical, yawed), Alignment::kYaw), yawed);
}

TEST(Align, NoneIsTheIdentity) {
  expect_same(align(transformed(kSpread, kTurnedAndScaled), Alignment::kNone), {});
  expect_same(align({}, Alignment::kSim3), {});
}

TEST(Align, PositionsInAPlaneAreEnough) {
  const std::vector<Vector3d> plane{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {3, 1, 0}};
  expect_same(align(transformed(plane, kTurnedAndScaled), Alignment::kSim3), kTurnedAndScaled);
}

TEST(Align, OnALineTheOrientationsDecideTheRoll) {
  const std::vector<Vector3d> line{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
  expect_same(align(transformed(line, kTurnedAndScaled), Alignment::kSim3), kTurnedAndScaled);
}

TEST(Align, OnANearlyStraightPathTheOrientationsDecideTheRoll) {
  // A path that bends by less than its positions are off by, in other directions.
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 20; ++i) {
    const double x = 0.1 * i - 1;
    const Rigid3 pose(about({1, 0.5, -2}, 0.05 * i), {x, 0.003 * x * x, 0});
    Rigid3 truth = kTurnedAndScaled * pose;
    truth = Rigid3(truth.rotation(),
                   kTurnedAndScaled * Vector3d(x, 0.001 * std::sin(7 * x), 0.003 * x * x));
    pairs.push_back({pose, truth});
  }
  const Similarity found = align(pairs, Alignment::kSim3);
  EXPECT_LT(angle_between(found.rigid.rotation(), kTurnedAndScaled.rigid.rotation()), 0.01);
  EXPECT_NEAR(found.scale, kTurnedAndScaled.scale, 1e-3);
}

TEST(Align, PositionsAloneAreAlignedBetterThanWithTheirOrientations) {
  // Two equal bends with errors across them: the orientations say another roll.
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 20; ++i) {
    const double x = 0.1 * i - 1;
    pairs.push_back({Rigid3(about({1, 0, 0}, 0.2), {x, 0.01 * x * x, 0}),
                     Rigid3(Quaterniond::Identity(), {x, 0.01 * x * x, 0.004 * std::sin(5 * x)})});
  }
  const auto squares = [&](const Similarity& s) {
    double sum = 0;
    for (const PosePair& pair : pairs)
      sum += (s * pair.estimated.translation() - pair.truth.translation()).squaredNorm();
    return sum;
  };
  EXPECT_LT(squares(align_positions(pairs, Alignment::kSe3)),
            squares(align(pairs, Alignment::kSe3)));
  expect_same(align_positions(transformed(kSpread, kTurnedAndScaled), Alignment::kSim3),
              kTurnedAndScaled);
  expect_same(align_positions({}, Alignment::kSim3), {});
}

TEST(Align, WhereThePathBendsThePositionsDecideAlone) {
  std::vector<PosePair> pairs = transformed(kSpread, kTurnedAndScaled);
  for (PosePair& pair : pairs)
    pair.estimated =
        Rigid3(about({0, 1, 0}, 0.5) * pair.estimated.rotation(), pair.estimated.translation());
  expect_same(align(pairs, Alignment::kSim3), kTurnedAndScaled);
}

TEST(Align, AtAStandstillTheOrientationsDecideAlone) {
  const std::vector<Vector3d> point{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  expect_same(align(transformed(point, kTurned), Alignment::kSim3), kTurned);
  expect_same(align(transformed({{1, 2, 3}}, kTurned), Alignment::kSe3), kTurned);
}

TEST(Align, NeverReturnsAReflection) {
  std::vector<PosePair> pairs;
  for (const Vector3d& p : kSpread)
    pairs.push_back({Rigid3(Quaterniond::Identity(), p),
                     Rigid3(Quaterniond::Identity(), Vector3d(p.x(), p.y(), -p.z()))});
  for (PosePair& pair : pairs)
    pair.truth = Rigid3(Quaterniond::Identity(), pair.truth.translation());
  const Similarity s = align(pairs, Alignment::kSe3);
  EXPECT_NEAR(s.rigid.rotation_matrix().determinant(), 1, 1e-12);
}

TEST(Align, LeastSquaresOfAHandComputedCase) {
  // Estimate (-1, 0), (1, 0), (0, -1), (0, 1) in a plane; truth the same times 2, except that the
  // third point is 3 (not 2) away. Means (0, -1/4): covariance diag(4, 5) / 4, variance 4/4.
  const std::vector<Vector3d> estimate{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}};
  const std::vector<Vector3d> truth{{-2, 0, 0}, {2, 0, 0}, {0, -3, 0}, {0, 2, 0}};
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < 4; ++i)
    pairs.push_back(
        {Rigid3(Quaterniond::Identity(), estimate[i]), Rigid3(Quaterniond::Identity(), truth[i])});
  const Similarity s = align(pairs, Alignment::kSim3);
  EXPECT_NEAR(s.scale, 9.0 / 4, 1e-12);
  EXPECT_LT((s.rigid.translation() - Vector3d(0, -0.25, 0)).norm(), 1e-12);
  EXPECT_LT(angle_between(s.rigid.rotation(), Quaterniond::Identity()), 1e-9);
}

TEST(Align, AnEstimateThatStandsStillKeepsScaleOne) {
  std::vector<PosePair> pairs = transformed(kSpread, kTurned);
  for (PosePair& pair : pairs)
    pair.estimated = Rigid3(pair.estimated.rotation(), Vector3d(7, 7, 7));
  const Similarity s = align(pairs, Alignment::kSim3);
  EXPECT_EQ(s.scale, 1);
  EXPECT_TRUE(s.rigid.translation().allFinite());
}

TEST(Align, TurnsOrientationsByItsRotationAlone) {
  const Rigid3 pose(about({0, 0, 1}, kPi / 6), {1, 0, 0});
  const Similarity s{3, Rigid3(about({0, 0, 1}, kPi / 2), {0, 0, 1})};
  const Rigid3 moved = s * pose;
  EXPECT_LT((moved.translation() - Vector3d(0, 3, 1)).norm(), 1e-12);
  EXPECT_LT(angle_between(moved.rotation(), about({0, 0, 1}, 2 * kPi / 3)), 1e-12);
}

double view_cost(std::span<const PosePair> pairs, const Similarity& aligned, double depth_m) {
  double sum = 0;
  for (const PosePair& pair : pairs) {
    const Rigid3 pose = aligned * pair.estimated;
    sum += (pose.translation() - pair.truth.translation()).squaredNorm() / (depth_m * depth_m);
    sum += (pose.rotation_matrix() - pair.truth.rotation_matrix()).squaredNorm() / 2;
  }
  return sum;
}

TEST(AlignViews, LeavesLeastOfPositionsAndOrientationsTogether) {
  // Of a path of decimetres the positions say the rotation to a degree, the orientations to a tenth.
  const Random random(5);
  std::uint64_t drawn = 0;
  const auto normal = [&] { return random.normal(0, drawn++); };
  std::vector<PosePair> pairs;
  const Similarity moved{2.5, Rigid3(so3_exp({0.4, -1, 2}), {1, 2, 3})};
  for (int i = 0; i < 50; ++i) {
    const Rigid3 estimated(so3_exp({0.01 * i, 0, 0.1}),
                           {0.002 * i, 0.02 * std::sin(0.2 * i), 0.01 * std::cos(0.3 * i)});
    const Vector3d turn{normal(), normal(), normal()};
    const Vector3d shift{normal(), normal(), normal()};
    const Rigid3 truth = moved * estimated;
    pairs.push_back({estimated, Rigid3(so3_exp(0.002 * turn) * truth.rotation(),
                                       truth.translation() + 0.005 * shift)});
  }
  constexpr double kDepth_m = 3;
  for (const Alignment alignment : {Alignment::kSim3, Alignment::kSe3, Alignment::kYaw}) {
    const Similarity found = align_views(pairs, alignment, kDepth_m);
    const double least = view_cost(pairs, found, kDepth_m);
    for (int i = 0; i < 7; ++i)
      for (const double step : {-1e-4, 1e-4}) {
        const bool is_free = alignment == Alignment::kSim3 ||
                             (alignment == Alignment::kSe3 && i < 6) ||
                             (alignment == Alignment::kYaw && (i < 3 || i == 5));
        if (!is_free) continue;
        Twist twist = Twist::Zero();
        if (i < 6) twist[i] = step;
        Similarity other = found;
        if (i == 6) other.scale *= 1 + step;
        const Rigid3 nudge(so3_exp(twist.tail<3>()), twist.head<3>());
        other.rigid = nudge * other.rigid;
        EXPECT_GE(view_cost(pairs, other, kDepth_m), least) << i << " " << step;
      }
  }
  const Similarity found = align_views(pairs, Alignment::kSim3, kDepth_m);
  EXPECT_LT(angle_between(found.rigid.rotation(), moved.rigid.rotation()), 0.002);
  EXPECT_GT(angle_between(align(pairs, Alignment::kSim3).rigid.rotation(), moved.rigid.rotation()),
            0.004)
      << "by positions";
  EXPECT_NEAR(found.scale, 2.5, 0.1);
}

TEST(AlignViews, OfPositionsAndOrientationsThatAgreeIsExact) {
  std::vector<PosePair> pairs;
  const Similarity moved{0.2, Rigid3(so3_exp({0, 3, 0.1}), {-4, 0, 1})};
  for (int i = 0; i < 10; ++i) {
    const Rigid3 estimated(so3_exp({0.1 * i, 0.2, 0}), {0.1 * i, 0.01 * i * i, 0});
    pairs.push_back({estimated, moved * estimated});
  }
  const Similarity found = align_views(pairs, Alignment::kSim3, 1);
  EXPECT_NEAR(found.scale, 0.2, 1e-9);
  EXPECT_LT(angle_between(found.rigid.rotation(), moved.rigid.rotation()), 1e-6);
  EXPECT_TRUE(align_views({}, Alignment::kSim3, 1).rigid.translation().isZero());
}

}  // namespace
}  // namespace saccade
