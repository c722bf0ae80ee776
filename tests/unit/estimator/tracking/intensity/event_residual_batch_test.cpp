#include "estimator/tracking/intensity/event_residual_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"
#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::central_differences;
using testing::small_uneven_camera;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr float kEventSigma = 0.05F;
constexpr float kTail = 2.4F;
/// Of an observation itself: n^2 / (n^2 + P) = 0.8.
constexpr float kVariance = 0.25F * kEventSigma * kEventSigma;

/// Gentle slopes that differ from cell to cell.
ImageF some_atlas() {
  const Random random(3);
  ImageF atlas(64, 48);
  for (std::size_t i = 0; i < atlas.size(); ++i)
    atlas.pixels()[i] = static_cast<float>(0.4 * random.uniform(0, i) - 1);
  return atlas;
}

/// Of a map's positions, the same all over it.
constexpr float kPositionVariance = 0.07F;
ImageF position_variance(const ImageF& atlas) {
  return {atlas.width(), atlas.height(), kPositionVariance};
}

struct Sight {
  LogIntensityObservation observation;
  MapSample seen;
};

Rigid3 some_pose() { return {so3_exp({0.1, -0.05, 0.2}), {0.02, -0.03, 0.05}}; }

EventResidualBatch::Motion motion_at(const Rigid3& map_from_camera, const Vector6& velocity) {
  const Rigid3 camera_from_map = map_from_camera.inverse();
  return {camera_from_map.rotation_matrix().cast<float>(),
          camera_from_map.translation().cast<float>(), velocity.cast<float>()};
}

/// What a pixel sees at a depth from some_pose(); the place is in the middle of a cell, where the
/// interpolant is smooth over what a test moves.
Sight sight(const Eigen::Vector2d& pixel, double depth_m, float level, float time_s = 0) {
  const Eigen::Vector3d point = some_pose() * (depth_m * small_uneven_camera().ray(pixel));
  Sight sight;
  sight.observation = {pixel.cast<float>(), time_s, level, kVariance};
  sight.seen.point = point.cast<float>();
  sight.seen.inverse_depth = static_cast<float>(1 / depth_m);
  sight.seen.atlas_px = {std::floor(static_cast<float>(pixel.x())) + 0.5F,
                         std::floor(static_cast<float>(pixel.y())) + 0.5F};
  sight.seen.atlas_per_pixel << 0.9F, 0.1F, -0.2F, 1.1F;
  return sight;
}

EventResidualBatch::Sums sums_of(EventResidualBatch& batch, float sigma, const ImageF& atlas,
                                 const Rigid3& pose = some_pose(),
                                 const Vector6& velocity = Vector6::Zero(),
                                 float position_sigma_px = 0) {
  batch.evaluate(small_uneven_camera(), atlas, position_variance(atlas), motion_at(pose, velocity));
  batch.weigh({sigma, position_sigma_px});
  EventResidualBatch::Sums sums;
  batch.add_to(sums);
  return sums;
}

/// Of one event; NaN where it sees nothing.
double residual_of(const Sight& sight, const Rigid3& pose, const Vector6& velocity,
                   const ImageF& atlas) {
  EventResidualBatch batch;
  batch.add(sight.observation, sight.seen);
  batch.evaluate(small_uneven_camera(), atlas, position_variance(atlas), motion_at(pose, velocity));
  return static_cast<double>(batch.residual(0));
}

/// Compares the row of the Jacobian of one event with differences of its residual, which falls as
/// the map's log intensity rises; `tolerance` is relative to the row's largest entry.
void expect_row(const Sight& sight, const Vector6& velocity, double tolerance) {
  const ImageF atlas = some_atlas();
  EventResidualBatch batch;
  batch.add(sight.observation, sight.seen);
  const EventResidualBatch::Sums sums = sums_of(batch, kEventSigma, atlas, some_pose(), velocity);
  const auto residual = [&](const Vector6& twist) {
    return Eigen::Matrix<double, 1, 1>(
        residual_of(sight, some_pose() * Rigid3::exp(twist), velocity, atlas));
  };
  // A step of some 0.06 px: small within a cell, large against single precision.
  const Vector6 numeric =
      -central_differences<1, 6>(residual, Vector6(Vector6::Zero()), 1e-3).transpose();
  ASSERT_TRUE(numeric.allFinite());
  const double r = residual(Vector6::Zero())(0);
  ASSERT_GT(std::abs(r), 0.01) << "the test needs a residual";
  // The weight over all variances in place of that over the pixel's.
  const double n2 = static_cast<double>(kEventSigma * kEventSigma);
  const double x =
      r / (static_cast<double>(kTail) * std::sqrt(n2 + static_cast<double>(kVariance)));
  const double weight = n2 / (n2 + static_cast<double>(kVariance)) / (1 + x * x);
  const Vector6 row = sums.rhs / (weight * r);
  const double scale = numeric.cwiseAbs().maxCoeff();
  EXPECT_LT((row - numeric).cwiseAbs().maxCoeff(), tolerance * scale)
      << row.transpose() << "\nnumeric " << numeric.transpose();
  const Matrix6 squared = sums.normal.selfadjointView<Eigen::Upper>();
  EXPECT_LT((squared / weight - numeric * numeric.transpose()).cwiseAbs().maxCoeff(),
            3 * tolerance * scale * scale);
}

TEST(EventResidualBatch, JacobianIsThatOfTheResidual) {
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(7, 9), {50, 12}, {31, 24}, {12, 40}})
    for (const double depth : {0.7, 3.0})
      expect_row(sight(pixel, depth, -0.5F), Vector6::Zero(), 2e-3);
}

TEST(EventResidualBatch, JacobianHoldsBeforeAndAfterTheInstantOfThePose) {
  Vector6 velocity;
  velocity << 0.5, -0.3, 0.2, 1, -1.5, 2;
  // The row leaves out the turn within the time: here up to 0.7 % of it.
  for (const float time_s : {-2e-3F, 2e-3F})
    expect_row(sight({50, 12}, 1.5, -0.5F, time_s), velocity, 1e-2);
}

TEST(EventResidualBatch, ResidualIsTheLevelAboveTheMapWhereTheEventLooks) {
  const ImageF atlas = some_atlas();
  const Sight here = sight({20, 30}, 2, -0.4F);
  const double shown =
      static_cast<double>(sample(atlas, here.seen.atlas_px.x(), here.seen.atlas_px.y()));
  EXPECT_NEAR(residual_of(here, some_pose(), Vector6::Zero(), atlas), -0.4 - shown, 1e-4);
}

TEST(EventResidualBatch, VelocityMovesThePlaceWithTime) {
  // An event t later sees what a camera moved on by t times the velocity sees.
  const ImageF atlas = some_atlas();
  Vector6 velocity;
  velocity << 0.5, -0.3, 0.2, 1, -1.5, 2;
  for (const double t : {-1e-3, 1e-3}) {
    const Rigid3 then = some_pose() * Rigid3::exp(velocity * t);
    const double later =
        residual_of(sight({20, 30}, 2, 0, static_cast<float>(t)), some_pose(), velocity, atlas);
    const double moved = residual_of(sight({20, 30}, 2, 0), then, Vector6::Zero(), atlas);
    const double still = residual_of(sight({20, 30}, 2, 0), some_pose(), Vector6::Zero(), atlas);
    EXPECT_NEAR(later, moved, 1e-4);
    EXPECT_GT(std::abs(still - moved), 1e-3) << "the test must move";
  }
}

TEST(EventResidualBatch, WeightsAreCauchysOverTheVariancesOfMapAndPixel) {
  const ImageF atlas = some_atlas();
  for (const float level : {-0.8F, -0.5F, 2.0F})
    for (const float sigma : {0.025F, 0.05F, 0.1F})
      for (const float position_sigma_px : {0.0F, 0.3F}) {
        EventResidualBatch batch;
        const Sight here = sight({20, 30}, 2, level);
        batch.add(here.observation, here.seen);
        const EventResidualBatch::Sums sums =
            sums_of(batch, sigma, atlas, some_pose(), Vector6::Zero(), position_sigma_px);
        const double map = static_cast<double>(
            sigma * sigma + position_sigma_px * position_sigma_px * kPositionVariance);
        EXPECT_NEAR(batch.map_variance(0), map, 1e-6);
        EXPECT_NEAR(batch.variance_per_px2(0), kPositionVariance, 1e-6);
        const double known = static_cast<double>(sigma * sigma / (sigma * sigma + kVariance));
        const double r = static_cast<double>(batch.residual(0));
        const double x =
            r / (static_cast<double>(kTail) * std::sqrt(map + static_cast<double>(kVariance)));
        EXPECT_NEAR(sums.weight, known / (1 + x * x), 1e-5);
        EXPECT_NEAR(sums.squares, sums.weight * r * r, 1e-5 * (1 + r * r));
        EXPECT_NEAR(sums.known, known, 1e-6);
        EXPECT_NEAR(sums.inliers, std::abs(x) < 1 ? known : 0, 1e-6);
      }
}

TEST(EventResidualBatch, TheWeightOfARegionScalesTheEquationsAndNotTheEvidence) {
  const ImageF atlas = some_atlas();
  Sight here = sight({20, 30}, 2, -0.4F);
  EventResidualBatch usual, doubted;
  usual.add(here.observation, here.seen);
  here.observation.region_weight = 0.25F;
  doubted.add(here.observation, here.seen);
  const EventResidualBatch::Sums whole = sums_of(usual, kEventSigma, atlas);
  const EventResidualBatch::Sums part = sums_of(doubted, kEventSigma, atlas);
  EXPECT_TRUE(part.rhs.isApprox(0.25 * whole.rhs, 1e-5));
  EXPECT_TRUE(part.normal.isApprox(0.25 * whole.normal, 1e-5));
  EXPECT_EQ(part.known, whole.known);
  EXPECT_EQ(part.inliers, whole.inliers);
  EXPECT_EQ(part.squares, whole.squares);
}

TEST(EventResidualBatch, WithinItsDeadZoneAnObservationAgreesAndSaysNothingOfThePose) {
  const ImageF atlas = some_atlas();
  Sight here = sight({20, 30}, 2, -0.4F);
  const double far = residual_of(here, some_pose(), Vector6::Zero(), atlas);
  ASSERT_GT(std::abs(far), 0.2) << "the test needs a residual";
  here.observation.dead_zone = 0.15F;
  EXPECT_NEAR(residual_of(here, some_pose(), Vector6::Zero(), atlas),
              far - std::copysign(0.15, far), 1e-6);
  EventResidualBatch beyond, within;
  beyond.add(here.observation, here.seen);
  EXPECT_GT(sums_of(beyond, kEventSigma, atlas).normal.norm(), 0);
  here.observation.dead_zone = 2;
  within.add(here.observation, here.seen);
  const EventResidualBatch::Sums sums = sums_of(within, kEventSigma, atlas);
  EXPECT_EQ(sums.normal.norm(), 0);
  EXPECT_EQ(sums.rhs.norm(), 0);
  EXPECT_GT(sums.known, 0) << "it agrees with the map";
  EXPECT_EQ(sums.inliers, sums.known);
}

TEST(EventResidualBatch, WhatIsUncertainWeighsLess) {
  const ImageF atlas = some_atlas();
  const auto normal_of = [&](float variance, float position_sigma_px) {
    Sight here = sight({20, 30}, 2, 0);
    here.observation.variance = variance;
    // Without a residual there is no Cauchy weight.
    here.observation.log_intensity = sample(atlas, here.seen.atlas_px.x(), here.seen.atlas_px.y());
    EventResidualBatch batch;
    batch.add(here.observation, here.seen);
    return sums_of(batch, kEventSigma, atlas, some_pose(), Vector6::Zero(), position_sigma_px)
        .normal(0, 0);
  };
  const double certain = normal_of(0, 0);
  const double n2 = static_cast<double>(kEventSigma * kEventSigma);
  EXPECT_NEAR(normal_of(0.01F, 0) / certain, n2 / (n2 + 0.01), 1e-4);
  EXPECT_NEAR(normal_of(0.01F, 0.3F) / certain,
              n2 / (n2 + 0.01 + 0.09 * static_cast<double>(kPositionVariance)), 1e-4);
  EXPECT_EQ(normal_of(std::numeric_limits<float>::infinity(), 0), 0) << "of an unknown pixel";
}

void expect_nothing(EventResidualBatch& batch, const ImageF& atlas,
                    const Rigid3& pose = some_pose()) {
  const EventResidualBatch::Sums sums = sums_of(batch, kEventSigma, atlas, pose);
  EXPECT_TRUE(std::isnan(batch.residual(0)));
  EXPECT_EQ(sums.rhs, Vector6(Vector6::Zero()));
  EXPECT_EQ(sums.normal, Matrix6(Matrix6::Zero()));
  EXPECT_EQ(sums.weight, 0);
  EXPECT_EQ(sums.known, 0);
  EXPECT_EQ(sums.inliers, 0);
}

TEST(EventResidualBatch, WhatSeesNothingOfTheMapWeighsNothing) {
  const ImageF atlas = some_atlas();
  const auto nothing_at = [&](const Eigen::Vector2f& place) {
    Sight outside = sight({20, 30}, 2, 0);
    outside.seen.atlas_px = place;
    EventResidualBatch batch;
    batch.add(outside.observation, outside.seen);
    expect_nothing(batch, atlas);
  };
  nothing_at({-0.1F, 20});
  nothing_at({20, -0.1F});
  nothing_at({63, 20});
  nothing_at({20, 47});
}

TEST(EventResidualBatch, FarFromWhereItWasLookedUpTheMapIsUnknown) {
  const ImageF atlas = some_atlas();
  Sight far = sight({20, 30}, 2, 0);
  far.observation.pixel.x() += 3.1F;
  EventResidualBatch batch;
  batch.add(far.observation, far.seen);
  expect_nothing(batch, atlas);
}

TEST(EventResidualBatch, UnknownTexelsWeighNothing) {
  ImageF atlas = some_atlas();
  const Sight here = sight({20, 30}, 2, 0);
  atlas(21, 31) = std::numeric_limits<float>::quiet_NaN();
  EventResidualBatch batch;
  batch.add(here.observation, here.seen);
  expect_nothing(batch, atlas);
}

TEST(EventResidualBatch, PointsBehindOrInTheCameraWeighNothing) {
  const ImageF atlas = some_atlas();
  const Sight here = sight({20, 30}, 2, 0);
  EventResidualBatch batch;
  batch.add(here.observation, here.seen);
  expect_nothing(batch, atlas, some_pose() * Rigid3({1, 0, 0, 0}, {0, 0, 5}));
  EventResidualBatch inside;
  Sight centre = here;
  centre.seen.point.setZero();
  inside.add(centre.observation, centre.seen);
  expect_nothing(inside, atlas, Rigid3());
}

/// Many events all over the view.
std::vector<Sight> some_sights(int count) {
  const Random random(8);
  std::vector<Sight> sights;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    const Eigen::Vector2d pixel(std::floor(60 * random.uniform(0, i)),
                                std::floor(44 * random.uniform(1, i)));
    sights.push_back(sight(pixel, 1 + 2 * random.uniform(2, i),
                           static_cast<float>(-0.6 - 0.4 * random.uniform(3, i))));
  }
  return sights;
}

EventResidualBatch chunk_of(const std::vector<Sight>& sights, int first, int count) {
  EventResidualBatch batch;
  for (int i = first; i < first + count; ++i) {
    const Sight& sight = sights[static_cast<std::size_t>(i)];
    batch.add(sight.observation, sight.seen);
  }
  return batch;
}

TEST(EventResidualBatch, LanesBehindTheLastEventWeighNothing) {
  const ImageF atlas = some_atlas();
  const auto sights = some_sights(EventResidualBatch::kCapacity);
  // What an earlier batch has left in them, and what was never there.
  EventResidualBatch used = chunk_of(sights, 0, EventResidualBatch::kCapacity);
  for (const int count : {1, 15, 16, 17, 40}) {
    used.clear();
    EventResidualBatch::Sums singly;
    for (int i = 0; i < count; ++i) {
      const Sight& sight = sights[static_cast<std::size_t>(i)];
      used.add(sight.observation, sight.seen);
      EventResidualBatch alone = chunk_of(sights, i, 1);
      const EventResidualBatch::Sums sums = sums_of(alone, kEventSigma, atlas);
      singly.rhs += sums.rhs;
      singly.normal += sums.normal;
      singly.known += sums.known;
      singly.weight += sums.weight;
    }
    EventResidualBatch fresh = chunk_of(sights, 0, count);
    for (EventResidualBatch* batch : {&used, &fresh}) {
      EXPECT_EQ(batch->size(), count);
      const EventResidualBatch::Sums sums = sums_of(*batch, kEventSigma, atlas);
      EXPECT_LT((sums.rhs - singly.rhs).norm(), 1e-5 * (1 + singly.rhs.norm()));
      EXPECT_LT((sums.normal - singly.normal).norm(), 1e-5 * singly.normal.norm());
      EXPECT_NEAR(sums.known, singly.known, 1e-4);
      EXPECT_NEAR(sums.weight, singly.weight, 1e-4);
    }
  }
}

TEST(EventResidualBatch, LanesBehindTheLastEventWeighNothingWhereTheMapBegins) {
  // They are zero in a new batch: points in the very centre of the first camera.
  const ImageF atlas = some_atlas();
  Sight here = sight({20, 30}, 2, -0.7F);
  here.seen.point = (2 * small_uneven_camera().ray({20, 30})).cast<float>();
  EventResidualBatch batch;
  batch.add(here.observation, here.seen);
  const EventResidualBatch::Sums sums = sums_of(batch, kEventSigma, atlas, Rigid3());
  EXPECT_TRUE(sums.rhs.allFinite());
  EXPECT_TRUE(sums.normal.allFinite());
  EXPECT_GT(sums.normal(0, 0), 0);
}

TEST(EventResidualBatch, OrderOfChunksIsRoundingOnly) {
  const ImageF atlas = some_atlas();
  const auto sights = some_sights(500);
  EventResidualBatch first = chunk_of(sights, 0, 256);
  EventResidualBatch second = chunk_of(sights, 256, 244);
  const auto sum = [&](std::vector<EventResidualBatch*> batches) {
    EventResidualBatch::Sums sums;
    for (EventResidualBatch* batch : batches) {
      batch->evaluate(small_uneven_camera(), atlas, position_variance(atlas),
                      motion_at(some_pose(), Vector6::Zero()));
      batch->weigh({kEventSigma, 0});
      batch->add_to(sums);
    }
    return sums;
  };
  const EventResidualBatch::Sums once = sum({&first, &second});
  const EventResidualBatch::Sums again = sum({&first, &second});
  const EventResidualBatch::Sums turned = sum({&second, &first});
  EXPECT_EQ(once.rhs, again.rhs);
  EXPECT_EQ(once.normal, again.normal);
  EXPECT_LT((once.rhs - turned.rhs).norm(), 1e-12 * once.rhs.norm());
  EXPECT_LT((once.normal - turned.normal).norm(), 1e-12 * once.normal.norm());
}

}  // namespace
}  // namespace saccade
