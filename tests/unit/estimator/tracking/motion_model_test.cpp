#include "estimator/tracking/motion_model.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace saccade {
namespace {

constexpr double kFocal_px = 200;
constexpr double kTypical_m = 2;
constexpr TimeNs kFrameStep = 10'000'000;  // 10 ms

MotionModelOptions constant_velocity() {
  MotionModelOptions options;
  options.prediction = MotionModelOptions::Prediction::kConstantVelocity;
  return options;
}

/// Some 40 px/s in every degree of freedom.
Twist steady_velocity() {
  Twist twist;
  twist << 0.4, -0.3, 0.5, 0.2, -0.1, 0.25;
  return twist;
}

Rigid3 pose_at(TimeNs t_ns) { return Rigid3::exp(steady_velocity() * seconds_from_ns(t_ns)); }

/// Follows the constant velocity with nearly exact poses for `frames` frames.
MotionModel trained(int frames) {
  MotionModel model(constant_velocity(), kFocal_px);
  model.reset(0, {});
  for (int i = 1; i <= frames; ++i) {
    static_cast<void>(model.predict(i * kFrameStep, kTypical_m));
    model.update(pose_at(i * kFrameStep), 1e12 * Matrix6::Identity());
  }
  return model;
}

double distance(const Rigid3& a, const Rigid3& b) { return (a.inverse() * b).log().norm(); }

TEST(MotionModel, NoPredictionStaysAndSaysNothing) {
  MotionModel model({}, kFocal_px);
  model.reset(0, pose_at(7));
  model.update(pose_at(kFrameStep), Matrix6::Identity());
  const PosePrediction prediction = model.predict(100 * kFrameStep, kTypical_m);
  EXPECT_LT(distance(prediction.map_from_camera, pose_at(kFrameStep)), 1e-15);
  EXPECT_EQ(prediction.precision, Matrix6::Zero());
}

TEST(MotionModel, PredictsConstantVelocity) {
  MotionModel model = trained(10);
  for (const int ahead : {1, 2, 5}) {
    MotionModel copy = model;
    const TimeNs t_ns = (10 + ahead) * kFrameStep;
    const double error = distance(copy.predict(t_ns, kTypical_m).map_from_camera, pose_at(t_ns));
    const double moved = distance(pose_at(10 * kFrameStep), pose_at(t_ns));
    EXPECT_LT(error, 0.02 * moved) << ahead;
  }
}

TEST(MotionModel, TurnsTowardsTheMotionInTheCameraFrame) {
  // A velocity along x of a camera that looks elsewhere: the prediction goes along ITS x.
  const Rigid3 turned(so3_exp({0, 1.5, 0}), {1, 2, 3});
  Twist along_x = Twist::Zero();
  along_x(0) = 0.5;
  MotionModel model(constant_velocity(), kFocal_px);
  model.reset(0, turned);
  for (int i = 1; i <= 10; ++i) {
    static_cast<void>(model.predict(i * kFrameStep, kTypical_m));
    model.update(turned * Rigid3::exp(along_x * seconds_from_ns(i * kFrameStep)),
                 1e12 * Matrix6::Identity());
  }
  const Rigid3 predicted = model.predict(11 * kFrameStep, kTypical_m).map_from_camera;
  EXPECT_LT(distance(predicted, turned * Rigid3::exp(along_x * 0.11)), 1e-4);
}

TEST(MotionModel, KnowsLessTheFurtherItLooksAhead) {
  double last = 1e300;
  for (const int ahead : {1, 2, 4, 8}) {
    MotionModel model = trained(10);
    const Matrix6 precision = model.predict((10 + ahead) * kFrameStep, kTypical_m).precision;
    const double strongest =
        Eigen::SelfAdjointEigenSolver<Matrix6>(precision).eigenvalues().maxCoeff();
    EXPECT_LT(strongest, last);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6>(precision).eigenvalues().minCoeff(), 0);
    last = strongest;
  }
}

TEST(MotionModel, MoreAgilityMeansLessTrust) {
  const auto precision_of = [](double agility) {
    MotionModelOptions options = constant_velocity();
    options.acceleration_sigma_px = agility;
    MotionModel model(options, kFocal_px);
    model.reset(0, {});
    for (int i = 1; i <= 10; ++i) {
      static_cast<void>(model.predict(i * kFrameStep, kTypical_m));
      model.update({}, 1e6 * Matrix6::Identity());
    }
    return model.predict(11 * kFrameStep, kTypical_m).precision.trace();
  };
  EXPECT_GT(precision_of(50), precision_of(500));
  EXPECT_GT(precision_of(500), precision_of(5000));
}

TEST(MotionModel, AnUninformativeFrameLeavesThePredictedVelocity) {
  MotionModel model = trained(10);
  const Rigid3 predicted = model.predict(11 * kFrameStep, kTypical_m).map_from_camera;
  model.update(predicted, Matrix6::Zero());
  EXPECT_LT(distance(model.predict(12 * kFrameStep, kTypical_m).map_from_camera,
                     pose_at(12 * kFrameStep)),
            1e-3);
}

TEST(MotionModel, StopKeepsThePoseAndForgetsTheVelocity) {
  MotionModel model = trained(10);
  model.stop();
  EXPECT_LT(distance(model.pose(), pose_at(10 * kFrameStep)), 1e-12);
  EXPECT_LT(distance(model.predict(11 * kFrameStep, kTypical_m).map_from_camera,
                     pose_at(10 * kFrameStep)),
            1e-12);
}

TEST(MotionModel, ResetForgetsEverything) {
  MotionModel used = trained(10);
  MotionModel fresh(constant_velocity(), kFocal_px);
  for (MotionModel* model : {&used, &fresh}) model->reset(kFrameStep, pose_at(3 * kFrameStep));
  for (int i = 2; i < 5; ++i) {
    const PosePrediction a = used.predict(i * kFrameStep, kTypical_m);
    const PosePrediction b = fresh.predict(i * kFrameStep, kTypical_m);
    EXPECT_LT(distance(a.map_from_camera, b.map_from_camera), 1e-15);
    EXPECT_EQ(a.precision, b.precision);
    used.update(pose_at(i * kFrameStep), 1e8 * Matrix6::Identity());
    fresh.update(pose_at(i * kFrameStep), 1e8 * Matrix6::Identity());
  }
}

/// A model that has seen no motion, with a gyroscope that turns all the while.
MotionModel with_gyroscope(const Eigen::Vector3d& rate, double sigma) {
  MotionModelOptions options;
  options.prediction = MotionModelOptions::Prediction::kImu;
  options.gyro_sigma = sigma;
  MotionModel model(options, kFocal_px);
  ImuSample sample;
  sample.angular_velocity = rate;
  model.set_gyroscope(
      Gyroscope(std::span(&sample, 1), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()));
  model.reset(0, {});
  return model;
}

TEST(MotionModel, TheGyroscopeTurnsTheFirstPrediction) {
  const Eigen::Vector3d rate(0.5, -1, 2);
  MotionModel model = with_gyroscope(rate, 0.01);
  const PosePrediction prediction = model.predict(kFrameStep, kTypical_m);
  EXPECT_LT(angle_between(prediction.map_from_camera.rotation(), so3_exp(rate * 0.01)), 1e-9);
  EXPECT_EQ(prediction.map_from_camera.translation(), Eigen::Vector3d::Zero());
}

TEST(MotionModel, TheGyroscopeOverrulesTheVelocityOfThePoses) {
  // The poses stand still but for a translation, the gyroscope says otherwise: the next prediction
  // turns, and goes on along the learnt translation.
  const Eigen::Vector3d rate(0, 0, 1);
  MotionModel model = with_gyroscope(rate, 0.01);
  for (int i = 1; i <= 10; ++i) {
    static_cast<void>(model.predict(i * kFrameStep, kTypical_m));
    model.update({{1, 0, 0, 0}, {0.01 * i, 0, 0}}, 1e12 * Matrix6::Identity());
  }
  const Rigid3 predicted = model.predict(11 * kFrameStep, kTypical_m).map_from_camera;
  EXPECT_LT(angle_between(predicted.rotation(), so3_exp(rate * 0.01)), 1e-4);
  EXPECT_NEAR(predicted.translation().x(), 0.11, 1e-3);
}

TEST(MotionModel, ABetterGyroscopeKnowsTheRotationBetter) {
  const auto precision = [](double sigma) {
    MotionModel model = with_gyroscope({0, 0, 0}, sigma);
    for (int i = 1; i <= 5; ++i) {
      static_cast<void>(model.predict(i * kFrameStep, kTypical_m));
      model.update({}, 1e8 * Matrix6::Identity());
    }
    return model.predict(6 * kFrameStep, kTypical_m).precision;
  };
  EXPECT_GT(precision(0.01)(4, 4), 1.5 * precision(1)(4, 4));
  EXPECT_NEAR(precision(0.01)(0, 0) / precision(1)(0, 0), 1, 0.01) << "translation is as before";
}

TEST(MotionModel, WhatMovesFastIsExpectedToChangeFast) {
  // Precision of the prediction after a while at constant velocity; in the direction of a turn.
  const auto precision = [](double share, double speed) {
    MotionModelOptions options = constant_velocity();
    options.acceleration_per_speed = share;
    MotionModel model(options, kFocal_px);
    model.reset(0, {});
    const Twist moving = speed * steady_velocity();
    for (int i = 1; i <= 10; ++i) {
      static_cast<void>(model.predict(i * kFrameStep, kTypical_m));
      model.update(Rigid3::exp(moving * seconds_from_ns(i * kFrameStep)),
                   1e12 * Matrix6::Identity());
    }
    return model.predict(11 * kFrameStep, kTypical_m).precision(4, 4);
  };
  EXPECT_NEAR(precision(0, 10) / precision(0, 1), 1, 0.01);
  EXPECT_LT(precision(6, 10), 0.1 * precision(6, 1));
  EXPECT_LT(precision(6, 1), precision(0, 1));
}

TEST(MotionModel, AStartIsAsPreciseAsItIsSaidToBe) {
  // At the start itself, before the unknown velocity counts.
  const auto sigma_px = [](double px) {
    MotionModel model(constant_velocity(), kFocal_px);
    model.reset(0, {}, px);
    return kFocal_px / std::sqrt(model.predict(0, kTypical_m).precision(4, 4));
  };
  EXPECT_NEAR(sigma_px(0.2), 0.2, 1e-6);
  EXPECT_NEAR(sigma_px(4), 4, 1e-6);
}

TEST(MotionModel, SpeedInTheImageIsThatOfTurnAndShift) {
  const Twist v = steady_velocity();
  EXPECT_NEAR(trained(10).speed_px(kTypical_m),
              kFocal_px * (v.tail<3>().norm() + v.head<3>().norm() / kTypical_m), 2);
}

TEST(MotionModel, TwoFramesAtTheSameTime) {
  MotionModel model = trained(10);
  const PosePrediction prediction = model.predict(10 * kFrameStep, kTypical_m);
  EXPECT_LT(distance(prediction.map_from_camera, pose_at(10 * kFrameStep)), 1e-12);
  EXPECT_TRUE(prediction.precision.allFinite());
}

TEST(MotionModel, StatesTheCovarianceOfThePose) {
  const Matrix6 information = 1e4 * Matrix6::Identity();
  MotionModel alone({}, 200);
  alone.reset(0, Rigid3());
  (void)alone.predict(1'000'000, 2);
  alone.update(Rigid3(), information);
  EXPECT_TRUE(alone.covariance().isApprox(1e-4 * Matrix6::Identity()));

  MotionModelOptions options;
  options.prediction = MotionModelOptions::Prediction::kConstantVelocity;
  MotionModel expecting(options, 200);
  expecting.reset(0, Rigid3());
  const PosePrediction predicted = expecting.predict(1'000'000, 2);
  expecting.update(Rigid3(), information);
  const Matrix6 both = predicted.precision + information;
  EXPECT_TRUE((expecting.covariance() * both).isApprox(Matrix6::Identity(), 1e-9));
}

}  // namespace
}  // namespace saccade
