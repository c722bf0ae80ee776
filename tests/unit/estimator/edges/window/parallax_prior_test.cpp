#include "estimator/edges/window/parallax_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace saccade {
namespace {

const PinholeCamera kFreeCamera = {160, 120, 150, 150, 79.5, 59.5, {}};
constexpr double kFreeDepth_m = 2;
constexpr DepthFreedom kFreedom{.edge_sigma = 0.02, .surface_sigma = 0.3, .edges_per_node = 4};

struct SeenEdge {
  std::vector<NodeSighting> events;
  double sigma_px;
};

std::vector<SeenEdge> seen_edges() {
  return {{{{0, 0}, {1, 0}, {2, 0}}, 0.1},
          {{{0, 0.25}, {1, 0.5}, {2, 0}}, 0.4},
          {{{0, 0}, {2, 0}}, 0.2}};
}

/// Sideways from the view by parallaxes of `px`; the last node ends the path.
std::vector<Rigid3> nodes_at(const std::vector<double>& px) {
  std::vector<Rigid3> nodes;
  for (const double p : px)
    nodes.emplace_back(so3_exp({0.1, -0.2, 0.05}),
                       Eigen::Vector3d(p * kFreeDepth_m / kFreeCamera.fx, 0, 0));
  nodes.push_back(nodes.back());
  return nodes;
}

/// What integrating the depths out adds to -ln of the posterior.
double integrated(const std::vector<double>& px) {
  double sum = 0;
  for (const SeenEdge& edge : seen_edges()) {
    double information = 0;
    for (const NodeSighting& event : edge.events) {
      const auto node = static_cast<std::size_t>(event.node);
      const double later = event.fraction > 0 ? event.fraction * px[node + 1] * px[node + 1] : 0;
      information += ((1 - event.fraction) * px[node] * px[node] + later) /
                     (2 * edge.sigma_px * edge.sigma_px);
    }
    const double n = kFreedom.edges_per_node;
    sum += std::log(1 + std::pow(kFreedom.edge_sigma, 2) * information) / 2 +
           std::log(1 + n * std::pow(kFreedom.surface_sigma, 2) * information) / (2 * n);
  }
  return sum;
}

TEST(ParallaxPrior, HasTheGradientOfWhatIsIntegratedOut) {
  const std::vector<double> px = {3, 0.4, 12};
  ParallaxPrior prior(kFreeCamera, kFreeDepth_m, nodes_at(px), kFreedom);
  for (const SeenEdge& edge : seen_edges()) prior.add_edge(edge.events, edge.sigma_px);
  constexpr double kStep_px = 1e-5;
  for (std::size_t i = 0; i < px.size(); ++i) {
    std::vector<double> more = px, less = px;
    more[i] += kStep_px;
    less[i] -= kStep_px;
    const double gradient = (integrated(more) - integrated(less)) / (2 * kStep_px);
    // A quarter of the edges and nodes count as independent.
    EXPECT_NEAR(4 * prior.information(static_cast<int>(i)) * px[i], gradient, 1e-6 * gradient);
  }
}

TEST(ParallaxPrior, SharesAnEventOutBetweenItsNodes) {
  ParallaxPrior prior(kFreeCamera, kFreeDepth_m, nodes_at({0, 0}), kFreedom);
  prior.add_edge(std::vector<NodeSighting>{{0, 0.25}}, 0.1);
  EXPECT_GT(prior.information(1), 0);
  EXPECT_NEAR(prior.information(0), 3 * prior.information(1), 1e-9 * prior.information(0));
}

TEST(ParallaxPrior, IsAboutTheViewsPlace) {
  ParallaxPrior prior(kFreeCamera, kFreeDepth_m, nodes_at({5, 5, 5}), kFreedom);
  prior.add_edge(seen_edges()[2].events, 0.1);
  const ParallaxPrior::OnNode node = prior.on_node(0);
  const Rigid3 corrected = nodes_at({5, 5, 5})[0] * Rigid3::exp(node.mean);
  EXPECT_LT(corrected.translation().norm(), 1e-12);
  // Whitened, the whole way back is as many sigmas as the parallax of 5 px.
  EXPECT_NEAR((node.root * node.mean).norm(), 5 * std::sqrt(prior.information(0)), 1e-9);
  EXPECT_LT((node.root * (Twist() << 0, 0, 0, 1, 2, 3).finished()).norm(), 1e-12)
      << "of a rotation it says nothing";
}

TEST(ParallaxPrior, AlongTheViewAWayMovesThePictureLess) {
  constexpr double kWay_m = 0.1;
  const std::vector<Rigid3> nodes(3, Rigid3({1, 0, 0, 0}, {0, 0, kWay_m}));
  ParallaxPrior prior(kFreeCamera, kFreeDepth_m, nodes, kFreedom);
  prior.add_edge(std::vector<NodeSighting>{{0, 0}, {1, 0}}, 0.1);
  double squares = 0, count = 0;
  for (int x = 0; x < kFreeCamera.width; ++x)
    for (int y = 0; y < kFreeCamera.height; ++y, ++count)
      squares += kFreeCamera.ray({x, y}).head<2>().squaredNorm();
  const double px = kFreeCamera.fx * kWay_m / kFreeDepth_m * std::sqrt(squares / count);
  const ParallaxPrior::OnNode node = prior.on_node(0);
  EXPECT_NEAR((node.root * node.mean).norm(), px * std::sqrt(prior.information(0)),
              1e-3 * px * std::sqrt(prior.information(0)));
}

TEST(ParallaxPrior, AnEdgeOfUnknownDepthTellsLessTheMoreParallaxThereIs) {
  const auto pull_of = [](double px) {
    ParallaxPrior prior(kFreeCamera, kFreeDepth_m, nodes_at({px, px, px}), kFreedom);
    for (const SeenEdge& edge : seen_edges()) prior.add_edge(edge.events, edge.sigma_px);
    return prior.information(0);
  };
  EXPECT_GT(pull_of(0.1), 3 * pull_of(5));
  EXPECT_GT(pull_of(5), 3 * pull_of(50));
}

}  // namespace
}  // namespace saccade
