#include "eval/information/information.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>

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
constexpr double kKnownDepth = 0.05;
/// Half of what success allows, so that a method at the bound succeeds in 19 of 20 worlds.
constexpr double kEnoughPercent = 0.5, kEnoughDeg = 2.5;
constexpr double kEnoughEdges = 0.05;

/// Of a recording without an edge that can fire.
constexpr Information kNothing{100, 180, 100, 100, 0};

using Observations = std::vector<LineObservation>;

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
  for (const LineObservation& o : observations)
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
  const auto row_of = [](const LineObservation& o) {
    return static_cast<Eigen::Index>(6 * o.node);
  };
  for (const LineObservation& o : observations)
    information.block<6, 6>(row_of(o), row_of(o)) +=
        count * o.weight * o.by_pose.transpose() * o.by_pose;
  if (is_known) return;
  const Eigen::Matrix2d covariance = edge_information(observations).inverse();
  for (std::size_t a = 0; a < observations.size(); ++a) {
    const LineObservation& o = observations[a];
    const Eigen::RowVector2d left = count * o.weight * o.by_edge * covariance;
    for (std::size_t b = 0; b <= a; ++b) {
      const LineObservation& other = observations[b];
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

/// Bounds of positions [m] and rotations [rad], RMS over the nodes.
struct PathBound {
  double position = 0, rotation = 0;
};

/// The covariance of the poses after the first `known` ones, which are given; nullopt where the
/// information does not determine it.
std::optional<Eigen::MatrixXd> covariance_of(const Eigen::MatrixXd& information,
                                             std::size_t known) {
  const Eigen::Index size = information.rows() - static_cast<Eigen::Index>(6 * known);
  const Eigen::LLT<Eigen::MatrixXd> factor(information.bottomRightCorner(size, size));
  if (factor.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(size, size));
  if (!covariance.allFinite() || (covariance.diagonal().array() < 0).any()) return std::nullopt;
  return covariance;
}

std::optional<PathBound> bound_of(const Eigen::MatrixXd& information, std::size_t known) {
  const auto covariance = covariance_of(information, known);
  if (!covariance) return std::nullopt;
  PathBound sum;
  for (Eigen::Index i = 0; i < covariance->rows(); i += 6) {
    sum.position += covariance->diagonal().segment<3>(i).sum();
    sum.rotation += covariance->diagonal().segment<3>(i + 3).sum();
  }
  const auto count = static_cast<double>(covariance->rows() / 6);
  return PathBound{std::sqrt(sum.position / count), std::sqrt(sum.rotation / count)};
}

/// An orthonormal basis of the ways in which a similarity transformation moves the nodes' positions,
/// all nodes but the first below one another. The first pose is held, which fixes the gauge of the
/// covariance; what is left after the best alignment does not depend on how it is fixed.
Eigen::MatrixXd similarity_basis(const std::vector<PathNode>& nodes) {
  Eigen::MatrixXd ways(3 * nodes.size() - 3, 7);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const Eigen::Vector3d position =
        nodes[i].world_from_camera.translation() - nodes.front().world_from_camera.translation();
    ways.middleRows<3>(static_cast<Eigen::Index>(3 * i - 3)) << Eigen::Matrix3d::Identity(),
        -skew(position), position;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(ways);
  return factor.householderQ() * Eigen::MatrixXd::Identity(ways.rows(), factor.rank());
}

/// RMS of the positions without a given start [m], after the best similarity transformation.
std::optional<double> own_bound_of(const Eigen::MatrixXd& information, const Problem& problem) {
  const std::vector<PathNode>& nodes = problem.nodes;
  const auto covariance = covariance_of(information, 1);
  if (!covariance) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(nodes.size()) - 1;
  Eigen::MatrixXd positions(3 * count, 3 * count);  // in the world
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b)
      positions.block<3, 3>(3 * a, 3 * b) =
          nodes[static_cast<std::size_t>(a) + 1].world_from_camera.rotation_matrix() *
          covariance->block<3, 3>(6 * a, 6 * b) *
          nodes[static_cast<std::size_t>(b) + 1].world_from_camera.rotation_matrix().transpose();
  const Eigen::MatrixXd basis = similarity_basis(nodes);
  const double left = positions.trace() - (basis.transpose() * positions * basis).trace();
  return std::sqrt(std::max(0.0, left) / static_cast<double>(count));
}

std::size_t given_nodes(const std::vector<PathNode>& nodes) {
  const double start_s = nodes.front().t_s;
  const double given_s = std::min(kStartS, kStartFraction * (nodes.back().t_s - start_s));
  const auto after = std::find_if(nodes.begin(), nodes.end(), [&](const PathNode& node) {
    return node.t_s > start_s + given_s;
  });
  // Of a camera that hardly moves the last node may lie within them.
  return std::min(static_cast<std::size_t>(after - nodes.begin()), nodes.size() - 1);
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
  problem.f = camera.fx;
  problem.mean_depth_m = mean_depth(edges, dataset.facts());
  problem.nodes = path_nodes(dataset.groundtruth(), edges, camera, problem.mean_depth_m);
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
  const double on = facts.contrast_on.value_or(facts.contrast_off.value_or(kUsualContrast));
  const double contrast = std::min(on, facts.contrast_off.value_or(on));
  // Below this the whole width of an edge is less than the threshold.
  const TrueEdges edges = find_true_edges(dataset, contrast / TrueEdges::kWidthPx);
  if (edges.frames.empty() || dataset.groundtruth().size() < 2) return std::nullopt;
  if (edges.edges.empty()) return kNothing;
  const Problem problem = problem_of(dataset, edges, contrast);
  const Eigen::MatrixXd path = path_information(problem, false);
  const auto tracking = bound_of(path_information(problem, true), 1);
  const auto odometry = bound_of(path, given_nodes(problem.nodes));
  const auto own = own_bound_of(path, problem);
  if (!tracking || !odometry || !own) return kNothing;
  const double percent = 100 / problem.mean_depth_m;
  return Information{percent * tracking->position, tracking->rotation * 180 / std::numbers::pi,
                     percent * odometry->position, percent * *own, share_of_known_depths(problem)};
}

}  // namespace saccade
