#include "simulator/scene/animation/vertex_animation.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

/// One vertex that goes along x: to 1 in half a second, on to 2 in a quarter, and, where it is
/// closed, back in another one.
MeshAnimation three_steps(bool closed) {
  MeshAnimation animation;
  animation.times_s = {0, 0.5, 0.75, 1};
  for (const float x : {0.0F, 1.0F, 2.0F, closed ? 0.0F : 3.0F}) {
    animation.vertices.push_back({Eigen::Vector3f(x, 0, 0)});
    animation.normals.push_back({Eigen::Vector3f::UnitY()});
  }
  return animation;
}

double x_at(const VertexAnimation& animation, double t_s) {
  return animation.vertex(animation.at(t_s), 0).x();
}
double speed_at(const VertexAnimation& animation, double t_s) {
  return animation.velocity(animation.at(t_s), 0).x();
}

TEST(VertexAnimation, StartsAtItsTimeAndStaysInItsLastPose) {
  const VertexAnimation animation(three_steps(false), Eigen::Affine3d::Identity(),
                                  {.name = "", .start_s = 2, .speed = 0.5, .loop = false});
  EXPECT_EQ(x_at(animation, 0), 0);
  EXPECT_EQ(speed_at(animation, 1.999), 0);
  EXPECT_DOUBLE_EQ(x_at(animation, 2.5), 0.5);
  EXPECT_DOUBLE_EQ(speed_at(animation, 2.5), 1);
  EXPECT_DOUBLE_EQ(x_at(animation, 3.25), 1.5);
  EXPECT_DOUBLE_EQ(speed_at(animation, 3.25), 2);
  EXPECT_DOUBLE_EQ(x_at(animation, 9), 3);
  EXPECT_EQ(speed_at(animation, 9), 0);
}

TEST(VertexAnimation, LoopsStartAgain) {
  const VertexAnimation animation(three_steps(true), Eigen::Affine3d::Identity(),
                                  {.name = "", .start_s = -0.25, .speed = 1, .loop = true});
  EXPECT_DOUBLE_EQ(x_at(animation, 0), 0.5);
  EXPECT_DOUBLE_EQ(x_at(animation, 5.0), 0.5);
  EXPECT_DOUBLE_EQ(speed_at(animation, 5.625), -8);
}

TEST(VertexAnimation, MovesAndTurnsIntoItsFrame) {
  Eigen::Affine3d turned = Eigen::Affine3d::Identity();
  turned.linear() << 0, -2, 0, 2, 0, 0, 0, 0, 1;
  turned.translation() = Eigen::Vector3d(1, 1, 1);
  const VertexAnimation animation(three_steps(false), turned, {});
  EXPECT_LT((animation.vertex(animation.at(0.25), 0) - Eigen::Vector3d(1, 2, 1)).norm(), 1e-6);
  EXPECT_LT((animation.velocity(animation.at(0.25), 0) - Eigen::Vector3d(0, 4, 0)).norm(), 1e-6);
  EXPECT_LT(animation.normal(animation.at(0.25), 0).normalized().y(), 1e-6);
}

TEST(VertexAnimation, FindsEveryKinkOnce) {
  const VertexAnimation animation(three_steps(true), Eigen::Affine3d::Identity(),
                                  {.name = "", .start_s = 0.1, .speed = 2, .loop = true});
  std::vector<double> kinks;
  double t_s = 0;
  while (const auto kink_s = animation.first_kink_s(t_s, 0.9)) kinks.push_back(t_s = *kink_s);
  const std::vector<double> expected{0.1, 0.35, 0.475, 0.6, 0.85};
  ASSERT_EQ(kinks.size(), expected.size());
  for (std::size_t i = 0; i < kinks.size(); ++i) EXPECT_NEAR(kinks[i], expected[i], 1e-9);
  EXPECT_FALSE(animation.first_kink_s(0.1, 0.35));
}

TEST(VertexAnimation, ALoopThatJumpsHasTwoSides) {
  const VertexAnimation animation(three_steps(false), Eigen::Affine3d::Identity(),
                                  {.name = "", .start_s = 0, .speed = 1, .loop = true});
  const auto before = animation.first_kink_s(0.8, 1.2);
  ASSERT_TRUE(before);
  EXPECT_NEAR(x_at(animation, *before), 3, 1e-6);
  const auto after = animation.first_kink_s(*before, 1.2);
  ASSERT_TRUE(after);
  EXPECT_NEAR(x_at(animation, *after), 0, 1e-6);
  EXPECT_LT(*after - *before, 3e-9);
  EXPECT_NEAR(animation.first_kink_s(*after, 2).value_or(0), 1.5, 1e-9);
}

}  // namespace
}  // namespace saccade
