#include "eval/information/information.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>

#include "eval/information/observations.h"
#include "eval/information/true_edges.h"

namespace saccade {
namespace {

/// Thresholds of a sensor that states none.
constexpr double kUsualContrast = 0.2;
/// What is known of an edge before: its depth within a factor of e, its place within ten pixels.
constexpr double kLogDepthSigma = 1;
constexpr double kPlaceSigmaPx = 10;
/// The given start of odometry, its default.
constexpr double kStartS = 0.2, kStartFraction = 0.1;
/// A scale that is fixed, against what the path is known to.
constexpr double kFixedScale = 1e-4;
constexpr double kKnownDepth = 0.05;
/// Half of what success allows, so that a method at the bound succeeds in 19 of 20 worlds.
constexpr double kEnoughPercent = 0.5, kEnoughDeg = 2.5;
constexpr double kEnoughEdges = 0.05;

/// Of a recording without an edge that can fire.
constexpr Information kNothing{100, 180, 100, 100, 0};

using Observations = std::vector<EdgeObservation>;

/// The observations of all edges, and of how many edges of their kind each speaks.
struct Problem {
  std::vector<PathNode> nodes;
  std::vector<Observations> edges;
  std::vector<double> counts;
  std::vector<double> pixels;  ///< that each stands for, over all frames
  double f = 0;                ///< focal length [px]
  double mean_depth_m = 0;
};

/// How many frames show an edge: each has it among its own edges.
std::size_t frames_with(const TrueEdge& edge, const TrueEdges& edges, const PinholeCamera& camera) {
  std::size_t count = 1;
  for (std::size_t i = 0; i < edges.frames.size(); ++i)
    if (i != edge.frame && edges.sight(camera, i, edge.point) == TrueEdges::Sight::kSeen) ++count;
  return count;
}

Eigen::Matrix2d edge_prior() {
  return Eigen::Vector2d(1 / (kLogDepthSigma * kLogDepthSigma), 1 / (kPlaceSigmaPx * kPlaceSigmaPx))
      .asDiagonal();
}

/// Information on an edge where the poses are known.
Eigen::Matrix2d edge_information(const Observations& observations) {
  Eigen::Matrix2d information = edge_prior();
  for (const EdgeObservation& o : observations)
    information += o.weight * o.by_edge.transpose() * o.by_edge;
  return information;
}

/// Of the edge pixels, over all frames.
double share_of_known_depths(const Problem& problem) {
  double known = 0, all = 0;
  for (std::size_t i = 0; i < problem.edges.size(); ++i) {
    const Eigen::Matrix2d covariance = edge_information(problem.edges[i]).inverse();
    known += covariance(0, 0) <= kKnownDepth * kKnownDepth ? problem.pixels[i] : 0;
    all += problem.pixels[i];
  }
  return all > 0 ? known / all : 0;
}

/// A pose that is held from one node to the next is not further off than the view moves: the error
///   xi_k - Ad(T_k^-1 T_(k-1)) xi_(k-1)
/// has a sigma of that motion, as an angle and times the mean depth as a way.
void add_holding(const std::vector<PathNode>& nodes, double f, double mean_depth_m,
                 Eigen::MatrixXd& information) {
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const double angle = std::max(nodes[i].motion_px, 1.0) / f;
    Twist sigma;
    sigma << Eigen::Vector3d::Constant(angle * mean_depth_m), Eigen::Vector3d::Constant(angle);
    const Matrix6 weight = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
    const Matrix6 carried =
        (nodes[i].world_from_camera.inverse() * nodes[i - 1].world_from_camera).adjoint();
    const auto row = static_cast<Eigen::Index>(6 * i);
    information.block<6, 6>(row, row) += weight;
    information.block<6, 6>(row, row - 6) -= weight * carried;
    information.block<6, 6>(row - 6, row - 6) += carried.transpose() * weight * carried;
  }
}

/// What the events of one edge tell about the poses. Where its place is not known, too, that leaves
///   A - B C^-1 B^T
/// of the blocks of its observations, the Schur complement of its two unknowns. Only the lower half
/// of the matrix is filled.
void add_edge(const Observations& observations, double count, bool is_known,
              Eigen::MatrixXd& information) {
  const auto row_of = [](const EdgeObservation& o) {
    return static_cast<Eigen::Index>(6 * o.node);
  };
  for (const EdgeObservation& o : observations)
    information.block<6, 6>(row_of(o), row_of(o)) +=
        count * o.weight * o.by_pose.transpose() * o.by_pose;
  if (is_known) return;
  const Eigen::Matrix2d covariance = edge_information(observations).inverse();
  for (std::size_t a = 0; a < observations.size(); ++a) {
    const EdgeObservation& o = observations[a];
    const Eigen::RowVector2d left = count * o.weight * o.by_edge * covariance;
    for (std::size_t b = 0; b <= a; ++b) {
      const EdgeObservation& other = observations[b];
      const double coupling = other.weight * left.dot(other.by_edge);
      information.block<6, 6>(row_of(o), row_of(other)) -=
          coupling * o.by_pose.transpose() * other.by_pose;
    }
  }
}

/// Information on all poses at once, before a map that is known or not.
Eigen::MatrixXd path_information(const Problem& problem, bool is_map_known) {
  const auto size = static_cast<Eigen::Index>(6 * problem.nodes.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  add_holding(problem.nodes, problem.f, problem.mean_depth_m, information);
  for (std::size_t i = 0; i < problem.edges.size(); ++i)
    add_edge(problem.edges[i], problem.counts[i], is_map_known, information);
  return information;
}

/// Bounds of positions [m] and rotations [rad], RMS over the poses.
struct PathBound {
  double position = 0, rotation = 0;
};

/// With the first `known` poses given, which have no error; there is one (contract).
PathBound bound_of(const Eigen::MatrixXd& information, std::size_t known) {
  const auto given = static_cast<Eigen::Index>(6 * known);
  const Eigen::Index size = information.rows() - given;
  if (size == 0) return {};
  const Eigen::LLT<Eigen::MatrixXd> factor(information.bottomRightCorner(size, size));
  const Eigen::VectorXd variances = factor.solve(Eigen::MatrixXd::Identity(size, size)).diagonal();
  PathBound sum;
  for (Eigen::Index i = 0; i < size; i += 6) {
    sum.position += variances.segment<3>(i).sum();
    sum.rotation += variances.segment<3>(i + 3).sum();
  }
  const auto count = static_cast<double>(information.rows() / 6);
  return {std::sqrt(sum.position / count), std::sqrt(sum.rotation / count)};
}

/// The same without a given start: the first pose is the world, and the distance to the node that is
/// furthest from it the unit.
PathBound own_bound_of(Eigen::MatrixXd information, const std::vector<PathNode>& nodes) {
  const Eigen::Vector3d& origin = nodes.front().world_from_camera.translation();
  const auto distance = [&](const PathNode& node) {
    return (node.world_from_camera.translation() - origin).norm();
  };
  const auto furthest = std::max_element(
      nodes.begin(), nodes.end(),
      [&](const PathNode& a, const PathNode& b) { return distance(a) < distance(b); });
  if (distance(*furthest) > 0) {
    const auto row = static_cast<Eigen::Index>(6 * (furthest - nodes.begin()));
    const Rigid3& pose = furthest->world_from_camera;
    const Eigen::Vector3d direction =
        pose.rotation().inverse() * (pose.translation() - origin).normalized();
    const double sigma = kFixedScale * distance(*furthest);
    information.block<3, 3>(row, row) += direction * direction.transpose() / (sigma * sigma);
  }
  return bound_of(information, 1);
}

std::size_t given_nodes(const std::vector<PathNode>& nodes) {
  const double start_s = nodes.front().t_s;
  const double given_s = std::min(kStartS, kStartFraction * (nodes.back().t_s - start_s));
  const auto after = std::find_if(nodes.begin(), nodes.end(), [&](const PathNode& node) {
    return node.t_s > start_s + given_s;
  });
  return static_cast<std::size_t>(after - nodes.begin());
}

double mean_depth(const TrueEdges& edges, const DatasetFacts& facts) {
  if (facts.mean_depth_m) return *facts.mean_depth_m;
  double sum = 0;
  for (const TrueEdge& edge : edges.edges) sum += edge.per_log_z.norm();
  return sum / static_cast<double>(edges.edges.size());
}

Problem problem_of(const Dataset& dataset, const TrueEdges& edges, double contrast) {
  const PinholeCamera& camera = dataset.camera();
  Problem problem;
  problem.nodes = path_nodes(dataset.groundtruth(), edges, camera);
  problem.f = camera.fx;
  problem.mean_depth_m = mean_depth(edges, dataset.facts());
  for (const TrueEdge& edge : edges.edges) {
    problem.edges.push_back(observe(camera, edges, edge, problem.nodes, contrast));
    problem.pixels.push_back(edge.pixels);
    problem.counts.push_back(edge.pixels / static_cast<double>(frames_with(edge, edges, camera)));
  }
  return problem;
}

}  // namespace

bool Information::is_enough_for(std::string_view module, bool has_given_start) const {
  if (module == "track") return pose_percent <= kEnoughPercent && pose_deg <= kEnoughDeg;
  if (module == "odometry")
    return (has_given_start ? path_percent : own_path_percent) <= kEnoughPercent;
  if (module == "depth") return depth_share >= kEnoughEdges;
  return true;
}

std::optional<Information> information_of(const Dataset& dataset) {
  const DatasetFacts& facts = dataset.facts();
  const double contrast = std::min(facts.contrast_on.value_or(kUsualContrast),
                                   facts.contrast_off.value_or(kUsualContrast));
  // Below this the whole width of an edge is less than the threshold.
  const TrueEdges edges = find_true_edges(dataset, contrast / TrueEdges::kWidthPx);
  if (edges.frames.empty()) return std::nullopt;
  if (edges.edges.empty()) return kNothing;
  const Problem problem = problem_of(dataset, edges, contrast);
  const double percent = 100 / problem.mean_depth_m;
  const PathBound tracking = bound_of(path_information(problem, true), 1);
  const Eigen::MatrixXd path = path_information(problem, false);
  Information found;
  found.pose_percent = percent * tracking.position;
  found.pose_deg = tracking.rotation * 180 / std::numbers::pi;
  found.path_percent = percent * bound_of(path, given_nodes(problem.nodes)).position;
  found.own_path_percent = percent * own_bound_of(path, problem.nodes).position;
  found.depth_share = share_of_known_depths(problem);
  return found;
}

}  // namespace saccade
