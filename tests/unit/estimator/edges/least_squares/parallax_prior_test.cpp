#include "estimator/edges/least_squares/parallax_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/random.h"
#include "estimator/edges/least_squares/bundle_solver.h"
#include "estimator/edges/least_squares/prior_cost.h"

namespace saccade {
namespace {

using SeenEvent = BundleEvent<2>;

const PinholeCamera kSeeing = {160, 120, 150, 150, 79.5, 59.5, {}};
constexpr FreeSurface kSurface{.node_sigma = 0.2, .edges_per_node = 4};

struct SeenEdge {
  Eigen::Vector2d pixel, normal;
  double depth_sigma;
  double sigma_px;
};

const std::vector<SeenEdge>& seen_edges() {
  static const std::vector<SeenEdge> edges = {{{20, 30}, {1, 0}, 0.02, 0.1},
                                              {{120, 40}, {0.6, 0.8}, 0.3, 0.3},
                                              {{60, 110}, {0, -1}, 0.05, 0.2}};
  return edges;
}

std::vector<Rigid3> moving_nodes() {
  return {Rigid3(so3_exp({0.02, -0.05, 0.01}), {-0.02, 0.01, 0.03}),
          Rigid3(so3_exp({0.01, -0.02, 0.2}), {0.002, -0.01, 0.01}),
          Rigid3(so3_exp({0, 0.3, 0.01}), {0.03, 0.02, -0.02})};
}

/// Each edge is seen at every node and between them, by poses whose nodes are moved by `twists`.
std::vector<SeenEvent> events_of(const SeenEdge& edge, const std::vector<Rigid3>& nodes,
                                 const std::vector<Twist>& twists) {
  std::vector<SeenEvent> events;
  for (std::size_t first = 0; first + 1 < nodes.size(); ++first)
    for (const double later : {0.0, 0.4, 1.0}) {
      SeenEvent event;
      const Twist moved = (1 - later) * twists[first] + later * twists[first + 1];
      const Rigid3& node = later < 1 ? nodes[first] : nodes[first + 1];
      event.observation.view_from_camera = node * Rigid3::exp(moved);
      event.observation.pixel = edge.pixel;
      event.observation.normal = edge.normal;
      event.sigma_px = edge.sigma_px;
      event.first = first;
      event.weight = {1 - later, later};
      events.push_back(event);
    }
  return events;
}

ParallaxPrior prior_of(const std::vector<Rigid3>& nodes, const FreeSurface& surface = kSurface) {
  ParallaxPrior prior(kSeeing, nodes.size(), surface);
  const std::vector<Twist> still(nodes.size(), Twist::Zero());
  for (const SeenEdge& edge : seen_edges()) {
    const std::vector<SeenEvent> events = events_of(edge, nodes, still);
    prior.add_edge(edge.depth_sigma, std::span<const SeenEvent>(events));
  }
  return prior;
}

/// By projection: how far an edge's point moves across it in the image, per inverse depth.
double parallax(const SeenEdge& edge, const Rigid3& view_from_camera) {
  constexpr double kSmall = 1e-6;
  const Eigen::Vector3d point = kSeeing.ray(edge.pixel) - kSmall * view_from_camera.translation();
  return edge.normal.dot(kSeeing.project(point) - edge.pixel) / kSmall;
}

/// What integrating the depths out adds to -ln of the posterior.
double integrated(const std::vector<Twist>& twists) {
  double of_edges = 0, information_of_all = 0;
  for (const SeenEdge& edge : seen_edges()) {
    std::vector<double> all;
    double mean = 0;
    for (const SeenEvent& event : events_of(edge, moving_nodes(), twists)) {
      all.push_back(parallax(edge, event.observation.view_from_camera));
      mean += all.back();
    }
    mean /= static_cast<double>(all.size());
    double information = 0;
    for (const double p : all) information += std::pow((p - mean) / edge.sigma_px, 2);
    of_edges += std::log(1 + std::pow(edge.depth_sigma, 2) * information) / 2;
    information_of_all += information;
  }
  const auto edges = static_cast<double>(seen_edges().size());
  const double n = kSurface.edges_per_node;
  return of_edges +
         edges / (2 * n) *
             std::log(1 + n * std::pow(kSurface.node_sigma, 2) * information_of_all / edges);
}

TEST(ParallaxPrior, HasTheGradientOfWhatIsIntegratedOut) {
  const std::vector<Rigid3> nodes = moving_nodes();
  const ParallaxPrior prior = prior_of(nodes);
  constexpr double kStep_m = 1e-6;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const ParallaxPrior::OnTwist on = prior.on(i);
    const Twist gradient = -on.root.transpose() * (on.root * on.mean);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Twist> more(nodes.size(), Twist::Zero()), less = more;
      more[i][axis] = kStep_m;
      less[i][axis] = -kStep_m;
      const double expected = (integrated(more) - integrated(less)) / (2 * kStep_m);
      // Half of the edges and nodes count as independent.
      EXPECT_NEAR(2 * gradient[axis], expected, 1e-4 * std::abs(expected) + 1e-3) << i << axis;
    }
    EXPECT_EQ(gradient.tail<3>().norm(), 0) << "of a rotation it says nothing";
  }
}

TEST(ParallaxPrior, WhereTheViewIsDoesNotMatter) {
  const std::vector<Rigid3> nodes = moving_nodes();
  std::vector<Rigid3> elsewhere;
  for (const Rigid3& node : nodes)
    elsewhere.emplace_back(node.rotation(), node.translation() + Eigen::Vector3d(0.5, -0.2, 0.3));
  const ParallaxPrior prior = prior_of(nodes), moved = prior_of(elsewhere);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_LT((prior.on(i).mean - moved.on(i).mean).norm(), 1e-9);
    EXPECT_LT((prior.on(i).root - moved.on(i).root).norm(), 1e-9 * prior.on(i).root.norm());
  }
}

TEST(ParallaxPrior, PullsLessTheMoreParallaxThereIs) {
  const auto information_of = [](double times) {
    std::vector<Rigid3> nodes;
    for (const Rigid3& node : moving_nodes())
      nodes.emplace_back(node.rotation(), times * node.translation());
    return prior_of(nodes).on(1).root.squaredNorm();
  };
  EXPECT_GT(information_of(0.1), 2 * information_of(1));
  EXPECT_GT(information_of(1), 50 * information_of(10));
}

TEST(ParallaxPrior, AnEdgeOfOneEventDrawsTheCameraNowhere) {
  ParallaxPrior prior(kSeeing, 2, kSurface);
  const std::vector<SeenEvent> one(
      1, events_of(seen_edges()[0], moving_nodes(), std::vector<Twist>(3, Twist::Zero()))[0]);
  prior.add_edge(0.1, std::span<const SeenEvent>(one));
  // It holds the node where it is: the information is an upper bound.
  EXPECT_GT(prior.on(0).root.norm(), 0);
  for (const std::size_t twist : {0U, 1U}) EXPECT_EQ(prior.on(twist).mean.norm(), 0) << twist;
}

/// A camera that turns and moves a little sideways, by the same steps from node to node, before a
/// scene of depths that are known to a third. The first nodes are known; it starts from the truth.
class TurningPath {
 public:
  static constexpr std::size_t kNodes = 8, kKnown = 2;
  static constexpr int kEdges = 1500;
  static constexpr double kNoise_px = 0.3, kDepthSigma = 0.3, kTypical = 1;

  explicit TurningPath(std::uint64_t seed)
      : path_(6 * kNodes, 0.0), bundle_(kSeeing, path_), random_(seed), unknowns_(kEdges) {
    ParallaxPrior prior(kSeeing, kNodes, {});
    for (std::size_t e = 0; e < kEdges; ++e) {
      const std::vector<SeenEvent> events = add_edge(e);
      prior.add_edge(kDepthSigma, std::span<const SeenEvent>(events));
    }
    for (std::size_t i = 0; i < kNodes; ++i) prior_.push_back(prior.on(i));
  }

  /// The sideways motion that is found until the last node, of the true one.
  double found_motion(bool with_prior) {
    for (std::size_t i = 0; i < kNodes; ++i) {
      const double sigma = i < kKnown ? 1e-5 : 1;
      add(i, Matrix6::Identity() / sigma, Twist::Zero());
      if (with_prior) add(i, prior_[i].root, prior_[i].mean);
    }
    EXPECT_TRUE(solve_bundle(bundle_, BundleSolver::kStructured, {20, 1e-10}).is_usable);
    const Eigen::Map<const Twist> last(path_.data() + 6 * (kNodes - 1));
    return (pose(kNodes - 1) * Rigid3::exp(last)).translation().x() /
           pose(kNodes - 1).translation().x();
  }

 private:
  static Rigid3 pose(std::size_t node) {
    const auto steps = static_cast<double>(node);
    return {so3_exp({0, 0.02 * steps, 0}), {0.0008 * steps, 0, 0}};
  }

  void add(std::size_t node, const Matrix6& root, const Twist& mean) {
    bundle_.add_factor(std::make_unique<LinearPriorCost<6>>(root, mean), {path_.data() + 6 * node});
  }

  std::vector<SeenEvent> add_edge(std::size_t e) {
    const Eigen::Vector2d pixel(10 + 140 * random_.uniform(e, 0), 10 + 100 * random_.uniform(e, 1));
    const double angle = 2 * M_PI * random_.uniform(e, 2);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const double inverse = kTypical + kDepthSigma * random_.normal(e, 3);
    const Eigen::Vector3d point = kSeeing.ray(pixel) / inverse;
    std::vector<SeenEvent> events;
    for (std::size_t node = 0; node < kNodes; ++node) {
      SeenEvent event;
      event.observation.view_from_camera = pose(node);
      const Eigen::Vector2d seen = kSeeing.project(pose(node).inverse() * point) +
                                   kNoise_px * random_.normal(e, 4 + node) * normal;
      event.observation.ray = kSeeing.ray(seen);
      event.observation.pixel = pixel;
      event.observation.normal = normal;
      event.sigma_px = kNoise_px;
      const bool is_last = node + 1 == kNodes;
      event.first = is_last ? node - 1 : node;
      event.weight = {is_last ? 0.0 : 1.0, is_last ? 1.0 : 0.0};
      events.push_back(event);
    }
    unknowns_[e] = {inverse, 0, 0, 0};
    const WindowBundle::Prior prior{{kTypical, 0, 0, 0}, {kDepthSigma, 2, 1e-3, 1e-3}};
    bundle_.add_edge(pixel, normal, unknowns_[e].data(), prior);
    for (const SeenEvent& event : events) (void)bundle_.add_event(event);
    return events;
  }

  std::vector<double> path_;
  WindowBundle bundle_;
  Random random_;
  std::vector<EdgeUnknowns> unknowns_;
  std::vector<ParallaxPrior::OnTwist> prior_;
};

TEST(ParallaxPrior, TakesTheMotionAwayThatNoiseLooksLike) {
  double without = 0, with = 0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    without += TurningPath(seed).found_motion(false) / kSeeds;
    with += TurningPath(seed).found_motion(true) / kSeeds;
  }
  EXPECT_GT(without, 3);
  EXPECT_NEAR(with, 1, 0.25);
}

}  // namespace
}  // namespace saccade
