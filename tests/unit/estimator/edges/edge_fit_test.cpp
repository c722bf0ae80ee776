#include "estimator/edges/edge_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/LU>

#include "estimator/edges/edge_noise.h"

namespace saccade {
namespace {

constexpr double kInverse = 0.4;
constexpr double kOffset_px = 0.3;
constexpr double kLag_px = 0.2;

PinholeCamera davis_camera() {
  PinholeCamera camera;
  camera.width = 240;
  camera.height = 180;
  camera.fx = camera.fy = 200;
  camera.cx = 119.5;
  camera.cy = 89.5;
  return camera;
}

/// Events of an upright edge by a camera that glides sideways: those rays that pass it exactly.
std::vector<EdgeObservation> observations(int count) {
  const PinholeCamera camera = davis_camera();
  std::vector<EdgeObservation> events;
  for (int i = 0; i < count; ++i) {
    EdgeObservation event;
    event.view_from_camera = {Eigen::Quaterniond::Identity(),
                              {0.3 * (i / (count - 1.0) - 0.5), 0, 0}};
    event.pixel = {120, 80};
    event.normal = {1, 0};
    event.lag = i % 2 == 0 ? 1 : -1;
    const double x = 120 + kOffset_px + kLag_px * event.lag -
                     camera.fx * kInverse * event.view_from_camera.translation().x();
    event.ray = camera.ray({x, 80 + 0.1 * (i % 5)});
    events.push_back(event);
  }
  return events;
}

const EdgePrior kPrior{{0.5, 0, 0, 0}, {0.5, 2, 0.3, 0.5}};

TEST(EdgeFit, FindsTheEdgeThatItsEventsSaw) {
  const auto edge = fit_edge(observations(40), davis_camera(), kPrior.mean, kPrior, 0.01);
  ASSERT_TRUE(edge);
  EXPECT_NEAR((*edge)[0], kInverse, 1e-3);
  EXPECT_NEAR((*edge)[1], kOffset_px, 1e-2);
  EXPECT_NEAR((*edge)[3], kLag_px, 1e-2);
}

TEST(EdgeFit, AFewOutliersChangeLittle) {
  std::vector<EdgeObservation> events = observations(40);
  for (const std::size_t i : {3U, 17U, 30U}) events[i].ray.x() += 0.01;
  const auto edge = fit_edge(events, davis_camera(), {0.42, 0.2, 0, 0.1}, kPrior, 0.05);
  ASSERT_TRUE(edge);
  EXPECT_NEAR((*edge)[0], kInverse, 4e-3);
}

TEST(EdgeFit, WeighsEveryEventAsCauchysLossDoes) {
  // Event by event, of numbers that do and do not fill the lanes that the fit works in.
  constexpr double kSigma_px = 0.05, kScale = EdgeNoise::kCauchyScale;
  for (const std::size_t count : {1U, 7U, 8U, 9U, 43U}) {
    std::vector<EdgeObservation> events = observations(60);
    events.resize(count);
    events[count / 2].ray.x() += 0.002;
    EdgeUnknowns expected{0.42, 0.2, 0.01, 0.1};
    const auto edge = fit_edge(events, davis_camera(), expected, kPrior, kSigma_px);
    ASSERT_TRUE(edge) << count;
    for (int i = 0; i < 4; ++i) {
      Eigen::Matrix4d square = kPrior.sigma.cwiseAbs2().cwiseInverse().asDiagonal();
      Eigen::Vector4d slope = square * (expected - kPrior.mean);
      for (const EdgeObservation& event : events) {
        EdgeDerivatives by;
        const double r = edge_residual(event, davis_camera(), Twist::Zero(), expected, &by);
        const double x = r / kSigma_px / kScale;
        const double weight = 1 / (kSigma_px * kSigma_px * (1 + x * x));
        square += weight * by.edge.transpose() * by.edge;
        slope += weight * r * by.edge.transpose();
      }
      expected -= square.inverse() * slope;
    }
    EXPECT_LT((*edge - expected).norm(), 1e-9) << count;
  }
}

TEST(EdgeFit, ThePriorHoldsWhatTheEventsDoNotTell) {
  // Without parallax: any depth fits.
  std::vector<EdgeObservation> events = observations(40);
  for (EdgeObservation& event : events) event.view_from_camera = Rigid3();
  const EdgePrior prior{{0.37, 0, 0, 0}, {0.01, 2, 0.3, 0.5}};
  const auto edge = fit_edge(events, davis_camera(), {0.4, 0, 0, 0}, prior, 0.01);
  ASSERT_TRUE(edge);
  EXPECT_NEAR((*edge)[0], 0.37, 1e-9);
}

TEST(EdgeFit, AnEdgeBehindTheViewIsNone) {
  std::vector<EdgeObservation> events = observations(40);
  // Mirrored parallax: as if seen at a negative depth.
  for (EdgeObservation& event : events)
    event.view_from_camera = {Eigen::Quaterniond::Identity(),
                              -event.view_from_camera.translation()};
  EXPECT_FALSE(fit_edge(events, davis_camera(), kPrior.mean, kPrior, 0.01));
}

/// An upright edge of an inverse depth that is read from one view.
Edgel upright_edge() {
  Edgel edge;
  edge.pixel = {120, 80};
  edge.normal = {1, 0};
  edge.inverse_depth = static_cast<float>(kInverse);
  return edge;
}

/// A landmark as seen from the view itself.
ProjectedLandmarks landmark_at(const Eigen::Vector2d& pixel, double inverse_depth, double sigma) {
  const PinholeCamera camera = davis_camera();
  const Landmark landmark{camera.ray(pixel) / inverse_depth, sigma};
  return {std::span(&landmark, 1), Rigid3(), camera};
}

TEST(EdgePrior, WithoutALandmarkIsThatOfAnyEdge) {
  const EdgeUnknowns unknowns(kInverse, 0.05, 0.1, 0.2);
  for (const ProjectedLandmarks& landmarks :
       {ProjectedLandmarks({}, Rigid3(), davis_camera()), landmark_at({123, 80}, kInverse, 0.01),
        landmark_at({120, 80}, 1.3 * kInverse, 0.01)}) {
    const EdgePrior prior = edge_prior(upright_edge(), unknowns, landmarks);
    EXPECT_EQ(prior.mean, unknowns);
    EXPECT_EQ(prior.sigma, EdgeNoise::prior_sigma(kInverse));
  }
}

TEST(EdgePrior, TakesDepthAndPlaceFromTheLandmarkThatTheEdgeLiesOn) {
  const EdgeUnknowns unknowns(kInverse, 0.05, 0.1, 0.2);
  const EdgePrior prior =
      edge_prior(upright_edge(), unknowns, landmark_at({120.4, 81}, 1.02 * kInverse, 0.004));
  EXPECT_NEAR(prior.mean[0], 1.02 * kInverse, 1e-9);
  EXPECT_NEAR(prior.sigma[0], std::hypot(0.004, 0.003) * 1.02 * kInverse, 1e-9);
  // Only across the edge: along it a landmark may be anywhere.
  EXPECT_NEAR(prior.mean[1], 0.4, 1e-6);
  EXPECT_NEAR(prior.sigma[1], 0.1, 1e-9);
  const EdgeUnknowns usual = EdgeNoise::prior_sigma(kInverse);
  for (int i = 2; i < 4; ++i) {
    EXPECT_EQ(prior.mean[i], unknowns[i]);
    EXPECT_EQ(prior.sigma[i], usual[i]);
  }
}

}  // namespace
}  // namespace saccade
