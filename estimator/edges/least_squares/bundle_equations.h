#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/process/parallel.h"
#include "estimator/edges/least_squares/bundle_rows.h"
#include "estimator/edges/least_squares/edge_chunks.h"
#include "estimator/edges/least_squares/path_information.h"
#include "estimator/edges/least_squares/reduced_system.h"
#include "estimator/edges/least_squares/small_cholesky.h"

namespace saccade {

/// The normal equations of a bundle with the edges eliminated (Triggs et al., 2000, section 6.1):
/// chunk after chunk (edge_chunks.h), each by one product of dense matrices; what they say is added
/// in their order, so that the sums are the same for any number of threads.
template <int kSupport, int kUnknowns>
class BundleEquations {
 public:
  using Rows = BundleRows<kSupport, kUnknowns>;
  using Point = typename Rows::Point;
  /// What is added to an entry of the diagonal, by the entry.
  using Damping = std::function<double(double)>;

  explicit BundleEquations(const Rows& rows)
      : BundleEquations(rows, 0, rows.bundle().edges().size()) {}

  /// Of the edges first .. last - 1 alone.
  BundleEquations(const Rows& rows, std::size_t first, std::size_t last)
      : rows_(rows), chunks_(chunks_of(first, last)), eliminated_(rows.bundle().edges().size()) {
    std::vector<std::vector<std::uint32_t>> groups;
    for (const EdgeChunk& chunk : chunks_) groups.push_back(chunk.blocks);
    for (const std::vector<std::uint32_t>& blocks : rows.kept().factor_blocks())
      groups.push_back(blocks);
    // Whoever asks for their covariance wants neighbours, whether an event couples them or not.
    const auto twists = static_cast<std::uint32_t>(rows.kept().path_blocks());
    for (std::uint32_t i = 0; i + kSupport <= twists; ++i) {
      groups.emplace_back(kSupport);
      std::iota(groups.back().begin(), groups.back().end(), i);
    }
    system_.emplace(rows.kept().begin(), groups);
  }

  /// The reduced system at `point`, where the rows were linearised.
  void build(const Point& point, const Damping& damping) {
    Eigen::VectorXd diagonal = sum_edges(point, damping);
    rows_.kept().add_to(*system_, gradient_, right_, diagonal);
    damping_.resize(system_->size());
    for (Eigen::Index i = 0; i < damping_.size(); ++i) damping_[i] = damping(diagonal[i]);
    system_->add_diagonal(damping_);
  }

  /// What the edges alone say of the path, from `point`, where their rows were linearised.
  [[nodiscard]] PathInformation path_information(const Point& point) {
    sum_edges(point, [](double) { return 0.0; });
    const auto size = static_cast<Eigen::Index>(rows_.bundle().path().size());
    return {system_->matrix().topLeftCorner(size, size), right_.head(size)};
  }

  /// The greatest derivative of the cost, absolute.
  [[nodiscard]] double greatest_slope() const {
    double greatest = gradient_.size() > 0 ? gradient_.cwiseAbs().maxCoeff() : 0;
    for (const Eliminated& edge : eliminated_)
      greatest = std::max(greatest, edge.gradient.cwiseAbs().maxCoeff());
    return greatest;
  }

  /// Takes the step from the point that the system was built at; by how much the model says that the
  /// cost falls. nullopt where the system cannot be solved.
  [[nodiscard]] std::optional<double> take_step(Point& point) {
    if (!system_->factorise()) return std::nullopt;
    step_ = -system_->solve(right_);
    if (!step_.allFinite()) return std::nullopt;
    const Point before = point;
    for (Eigen::Index i = 0; i < step_.size(); ++i)
      point.kept[static_cast<std::size_t>(i)] += step_[i];
    parallel_for(
        eliminated_.size(),
        [&](std::size_t e) {
          eliminated_[e].step = edge_step(e, before);
          point.edges[e] += eliminated_[e].step;
        },
        kEdgesAtOnce);
    // Of a step d with (H + D) d = -g, -g d - d H d / 2.
    double predicted = step_.dot(damping_.cwiseProduct(step_)) - gradient_.dot(step_);
    for (const Eliminated& edge : eliminated_)
      predicted +=
          edge.step.dot(edge.damping.cwiseProduct(edge.step)) - edge.gradient.dot(edge.step);
    return predicted / 2;
  }

  [[nodiscard]] double step_norm() const {
    double squares = step_.squaredNorm();
    for (const Eliminated& edge : eliminated_) squares += edge.step.squaredNorm();
    return std::sqrt(squares);
  }

  /// After build() without damping; empty where the matrix is not positive definite.
  [[nodiscard]] std::vector<Eigen::MatrixXd> path_covariances() {
    if (!system_->factorise()) return {};
    const std::size_t twists = rows_.kept().path_blocks();
    return system_->inverse_blocks(kSupport, twists + 1 > kSupport ? twists + 1 - kSupport : 0);
  }

 private:
  using Bundle = typename Rows::Bundle;
  using Edge = typename Rows::Edge;
  using Unknowns = typename Rows::Unknowns;
  using EdgeMatrix = typename Rows::EdgeMatrix;
  static constexpr int kMotion = 6 * kSupport;
  static constexpr std::size_t kWave = 16;  ///< chunks in memory at once
  using MotionVector = Eigen::Matrix<double, kMotion, 1>;
  using MotionMatrix = Eigen::Matrix<double, kMotion, kMotion>;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// What a chunk adds to the reduced system.
  struct Product {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd right, gradient, diagonal;
  };
  /// An edge's part of the normal equations, damped.
  struct Eliminated {
    SmallCholesky<kUnknowns> factor;
    Unknowns gradient, damping, step;
  };

  /// The part of the edges in the reduced system; the diagonal before they were eliminated.
  Eigen::VectorXd sum_edges(const Point& point, const Damping& damping) {
    system_->set_zero();
    right_ = Eigen::VectorXd::Zero(system_->size());
    gradient_ = right_;
    Eigen::VectorXd diagonal = right_;
    std::vector<Product> products(std::min(kWave, chunks_.size()));
    for (std::size_t wave = 0; wave < chunks_.size(); wave += kWave) {
      const std::size_t count = std::min(kWave, chunks_.size() - wave);
      parallel_for(
          count, [&](std::size_t k) { multiply(chunks_[wave + k], point, damping, products[k]); });
      for (std::size_t k = 0; k < count; ++k) {
        const EdgeChunk& chunk = chunks_[wave + k];
        system_->add(chunk.blocks, products[k].matrix);
        Eigen::Index local = 0;
        for (const std::uint32_t block : chunk.blocks) {
          const Eigen::Index at = rows_.kept().begin()[block], size = rows_.kept().size(block);
          right_.segment(at, size) += products[k].right.segment(local, size);
          gradient_.segment(at, size) += products[k].gradient.segment(local, size);
          diagonal.segment(at, size) += products[k].diagonal.segment(local, size);
          local += size;
        }
      }
    }
    return diagonal;
  }

  [[nodiscard]] std::vector<EdgeChunk> chunks_of(std::size_t first, std::size_t last) const {
    std::vector<CoupledEdge> edges(last - first);
    parallel_for(
        edges.size(),
        [&](std::size_t i) {
          edges[i] = {first + i, blocks_of(first + i)};
        },
        kEdgesAtOnce);
    return make_chunks(std::move(edges), kUnknowns, rows_.kept().begin());
  }

  [[nodiscard]] std::vector<std::uint32_t> blocks_of(std::size_t e) const {
    const Edge& edge = rows_.bundle().edges()[e];
    std::vector<std::uint32_t> first;
    for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i)
      for (std::size_t lane = 0; lane < kEventLanes; ++lane)
        if (rows_.bundle().lanes()[i].holds(lane))
          first.push_back(rows_.bundle().lanes()[i].first[lane]);
    std::sort(first.begin(), first.end());
    std::vector<std::uint32_t> blocks;
    for (const std::uint32_t begin : first) {
      std::uint32_t next = blocks.empty() ? begin : std::max(begin, blocks.back() + 1);
      for (; next < begin + kSupport; ++next) blocks.push_back(next);
    }
    // Nodes of a surface come after the path.
    if (!edge.link) return blocks;
    const std::size_t of_path = blocks.size();
    for (const double* node : edge.link->nodes) blocks.push_back(rows_.kept().place(node).block);
    std::sort(blocks.begin() + static_cast<std::ptrdiff_t>(of_path), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    return blocks;
  }

  /// y += s x, as a loop of one form: Eigen's own treats the elements before an aligned address by
  /// themselves, with other roundings, so that results would hang on where memory lies.
  static void add_scaled(double s, const double* x, int count, double* y) {
    for (int i = 0; i < count; ++i) y[i] += s * x[i];
  }
  /// Adds u v^T to rows that are `stride` apart.
  template <class Vector>
  static void add_product(const Vector& u, const double* v, int count, double* rows,
                          Eigen::Index stride) {
    for (Eigen::Index i = 0; i < u.size(); ++i) add_scaled(u[i], v, count, rows + i * stride);
  }

  /// A chunk's normal equations with its edges eliminated.
  void multiply(const EdgeChunk& chunk, const Point& point, const Damping& damping,
                Product& product) {
    const auto edges = static_cast<Eigen::Index>(chunk.edges.size());
    RowMajor cross = RowMajor::Zero(kUnknowns * edges, chunk.size);
    Eigen::VectorXd eliminated(kUnknowns * edges);
    product.matrix.setZero(chunk.size, chunk.size);
    product.gradient.setZero(chunk.size);
    // Sums over the events of one stretch of the path, small enough for the nearest cache.
    std::vector<MotionMatrix> squares(chunk.blocks.size(), MotionMatrix::Zero());
    for (std::size_t place = 0; place < chunk.edges.size(); ++place) {
      const std::size_t e = chunk.edges[place];
      const Edge& edge = rows_.bundle().edges()[e];
      const Eigen::Index first_row = kUnknowns * static_cast<Eigen::Index>(place);
      auto rows = cross.middleRows(first_row, static_cast<Eigen::Index>(kUnknowns));
      EdgeMatrix square;
      Unknowns& gradient = eliminated_[e].gradient;
      Rows::start_with_priors(edge, point.edges[e], square, gradient);
      for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i)
        for (std::size_t lane = 0; lane < kEventLanes; ++lane) {
          const EventLanes<kSupport>& events = rows_.bundle().lanes()[i];
          if (!events.holds(lane)) continue;
          const Eigen::Index column = chunk.column(events.first[lane]);
          MotionVector by_motion;
          for (int k = 0; k < kSupport; ++k)
            for (int j = 0; j < 6; ++j)
              by_motion[6 * k + j] = events.weight[static_cast<std::size_t>(k)][lane] *
                                     rows_.events()[i].by_motion[static_cast<std::size_t>(j)][lane];
          Unknowns by_edge;
          for (int j = 0; j < kUnknowns; ++j)
            by_edge[j] = rows_.events()[i].by_edge[static_cast<std::size_t>(j)][lane];
          const double residual = rows_.events()[i].residual[lane];
          add_product(by_motion, by_motion.data(), kMotion,
                      squares[static_cast<std::size_t>(column) / 6].data(), kMotion);
          add_product(by_edge, by_motion.data(), kMotion, &rows(0, column), cross.outerStride());
          add_scaled(residual, by_motion.data(), kMotion, &product.gradient[column]);
          add_product(by_edge, by_edge.data(), kUnknowns, square.data(), kUnknowns);
          add_scaled(residual, by_edge.data(), kUnknowns, gradient.data());
        }
      if (edge.link) add_link(edge, e, point, chunk, rows, square, product);
      for (int j = 0; j < kUnknowns; ++j) eliminated_[e].damping[j] = damping(square(j, j));
      square.diagonal() += eliminated_[e].damping;
      eliminated_[e].factor.compute(square);
      if (chunk.size > 0) eliminated_[e].factor.solve_lower(&rows(0, 0), chunk.size);
      auto half = eliminated.template segment<kUnknowns>(first_row);
      half = gradient;
      eliminated_[e].factor.solve_lower(half.data(), 1);
    }
    const auto twists = static_cast<std::size_t>(
        std::lower_bound(chunk.blocks.begin(), chunk.blocks.end(), rows_.kept().path_blocks()) -
        chunk.blocks.begin());
    for (std::size_t k = 0; k + kSupport <= twists; ++k) {
      const auto at = 6 * static_cast<Eigen::Index>(k);
      product.matrix.template block<kMotion, kMotion>(at, at) += squares[k];
    }
    product.diagonal = product.matrix.diagonal();
    product.matrix.template selfadjointView<Eigen::Lower>().rankUpdate(cross.transpose(), -1);
    product.right = product.gradient - cross.transpose() * eliminated;
  }

  void add_link(const Edge& edge, std::size_t e, const Point& point, const EdgeChunk& chunk,
                auto&& rows, EdgeMatrix& square, Product& product) {
    const typename Bundle::SurfaceLink& link = *edge.link;
    const auto [residual, weight] = rows_.link(edge, point.edges[e][0], point);
    const double by_rho = 1 / link.sigma;
    square(0, 0) += weight * by_rho * by_rho;
    eliminated_[e].gradient[0] += weight * by_rho * residual;
    std::array<Eigen::Index, 4> columns;
    for (std::size_t k = 0; k < 4; ++k) columns[k] = column_of(chunk, link.nodes[k]);
    for (std::size_t k = 0; k < 4; ++k) {
      const double by_node = -link.weights[k] * by_rho;
      rows(0, columns[k]) += weight * by_rho * by_node;
      product.gradient[columns[k]] += weight * by_node * residual;
      for (std::size_t j = 0; j < 4; ++j)
        if (columns[j] >= columns[k])
          product.matrix(columns[j], columns[k]) += weight * by_node * -link.weights[j] * by_rho;
    }
  }

  /// Of any kept unknown in a chunk's products.
  [[nodiscard]] Eigen::Index column_of(const EdgeChunk& chunk, const double* unknown) const {
    const KeptUnknowns::Place place = rows_.kept().place(unknown);
    Eigen::Index column = 0;
    for (const std::uint32_t block : chunk.blocks) {
      if (block == place.block) break;
      column += rows_.kept().size(block);
    }
    return column + static_cast<Eigen::Index>(place.index) - rows_.kept().begin()[place.block];
  }

  /// Of an edge, the step of the kept unknowns being known.
  [[nodiscard]] Unknowns edge_step(std::size_t e, const Point& point) const {
    const Edge& edge = rows_.bundle().edges()[e];
    const Eliminated& eliminated = eliminated_[e];
    Unknowns right = eliminated.gradient;
    for (std::size_t i = edge.first_lanes; i < edge.last_lanes; ++i) {
      const EventLanes<kSupport>& events = rows_.bundle().lanes()[i];
      const std::array<DoubleLanes, 6> motion =
          motion_of(events, {step_.data(), rows_.bundle().path().size()});
      DoubleLanes change{};
      for (std::size_t j = 0; j < 6; ++j) change += rows_.events()[i].by_motion[j] * motion[j];
      for (int j = 0; j < kUnknowns; ++j) {
        const DoubleLanes product = change * rows_.events()[i].by_edge[static_cast<std::size_t>(j)];
        for (std::size_t lane = 0; lane < kEventLanes; ++lane)
          if (events.holds(lane)) right[j] += product[lane];
      }
    }
    if (edge.link) {
      const double weight = rows_.link(edge, point.edges[e][0], point).weight;
      for (std::size_t k = 0; k < 4; ++k)
        right[0] -= weight / (edge.link->sigma * edge.link->sigma) * edge.link->weights[k] *
                    step_[static_cast<Eigen::Index>(rows_.kept().place(edge.link->nodes[k]).index)];
    }
    return -eliminated.factor.solve(right);
  }

  const Rows& rows_;
  std::vector<EdgeChunk> chunks_;
  std::optional<ReducedSystem> system_;
  std::vector<Eliminated> eliminated_;
  Eigen::VectorXd right_, gradient_, damping_, step_;
};

}  // namespace saccade
