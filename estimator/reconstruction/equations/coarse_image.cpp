#include "estimator/reconstruction/equations/coarse_image.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

/// Waves that are shorter than an event run, some ten pixels, are told by every observation and need no coarse
/// grid. Cells of 2 to 8 px take the same number of iterations within one or two, and the finer ones more time.
constexpr int kCell_px = 4;
/// The direct solution of more takes seconds: its time grows faster than their number.
constexpr double kMostCells = 1e5;
/// Of the mean diagonal: without levels the constant of the image is told by nothing.
constexpr double kRegularisation = 1e-6;

using Matrix4 = Eigen::Matrix4d;

/// Integral over a cell of the products of the slopes of its corners' bilinear functions, with M spread over it.
Matrix4 element(const Stiffness& m, const Eigen::Vector2d& cell_px) {
  Eigen::Matrix2d tensor;
  tensor << static_cast<double>(m.xx), static_cast<double>(m.xy), static_cast<double>(m.xy),
      static_cast<double>(m.yy);
  Matrix4 result = Matrix4::Zero();
  // Two points of Gauss along each side are exact for these products.
  const double offset = 0.5 / std::sqrt(3.0);
  for (const double a : {0.5 - offset, 0.5 + offset})
    for (const double b : {0.5 - offset, 0.5 + offset}) {
      Eigen::Matrix<double, 2, 4> slopes;
      slopes << -(1 - b), 1 - b, -b, b, -(1 - a), -a, 1 - a, a;
      slopes.row(0) /= cell_px.x();
      slopes.row(1) /= cell_px.y();
      result += 0.25 * slopes.transpose() * tensor * slopes;
    }
  return result;
}

/// Integral over a cell of the products of its corners' bilinear functions.
Matrix4 levels(double weight, const Eigen::Vector2d& cell_px) {
  Matrix4 products;
  products << 4, 2, 2, 1, 2, 4, 1, 2, 2, 1, 4, 2, 1, 2, 2, 4;
  return weight * cell_px.prod() / 36 * products;
}

}  // namespace

CoarseGrid::CoarseGrid(int width, int height, bool wraps) {
  SACCADE_CHECK(width > 1 && height > 1);
  int cell_px = kCell_px;
  while (static_cast<double>(width) * height > kMostCells * cell_px * cell_px) ++cell_px;
  columns_ = axis(width, cell_px, wraps);
  rows_ = axis(height, cell_px, false);
}

CoarseGrid::Axis CoarseGrid::axis(int pixels, int cell_px, bool wraps) {
  Axis axis;
  const int length = wraps ? pixels : pixels - 1;
  axis.cells = static_cast<std::size_t>((length + cell_px - 1) / cell_px);
  axis.nodes = wraps ? axis.cells : axis.cells + 1;
  axis.cell_px = static_cast<double>(length) / static_cast<double>(axis.cells);
  for (int i = 0; i < pixels; ++i) {
    const double at = i / axis.cell_px;
    axis.cell.push_back(std::min(static_cast<std::size_t>(at), axis.cells - 1));
    axis.fraction.push_back(at - static_cast<double>(axis.cell.back()));
  }
  return axis;
}

std::array<Eigen::Index, 4> CoarseGrid::nodes_of(std::size_t cell) const {
  const std::size_t left = cell % columns_.cells, top = cell / columns_.cells;
  const std::size_t right = node_after(columns_, left), bottom = node_after(rows_, top);
  const auto node = [&](std::size_t column, std::size_t row) {
    return static_cast<Eigen::Index>(row * columns_.nodes + column);
  };
  return {node(left, top), node(right, top), node(left, bottom), node(right, bottom)};
}

void CoarseGrid::interpolate(const Eigen::VectorXd& nodes, std::vector<float>& image) const {
  const Eigen::Map<const Eigen::MatrixXd> values(nodes.data(),
                                                 static_cast<Eigen::Index>(columns_.nodes),
                                                 static_cast<Eigen::Index>(rows_.nodes));
  Eigen::VectorXd row(values.rows());
  std::size_t i = 0;
  for (std::size_t y = 0; y < rows_.cell.size(); ++y) {
    const auto top = static_cast<Eigen::Index>(rows_.cell[y]);
    const double v = rows_.fraction[y];
    row = (1 - v) * values.col(top) + v * values.col(top + 1);
    for (std::size_t x = 0; x < columns_.cell.size(); ++x, ++i) {
      const std::size_t left = columns_.cell[x];
      const double u = columns_.fraction[x];
      image[i] +=
          static_cast<float>((1 - u) * row[static_cast<Eigen::Index>(left)] +
                             u * row[static_cast<Eigen::Index>(node_after(columns_, left))]);
    }
  }
}

Eigen::VectorXd CoarseGrid::restricted(const std::vector<float>& image) const {
  Eigen::VectorXd nodes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(this->nodes()));
  Eigen::Map<Eigen::MatrixXd> values(nodes.data(), static_cast<Eigen::Index>(columns_.nodes),
                                     static_cast<Eigen::Index>(rows_.nodes));
  Eigen::VectorXd row(values.rows());
  std::size_t i = 0;
  for (std::size_t y = 0; y < rows_.cell.size(); ++y) {
    row.setZero();
    for (std::size_t x = 0; x < columns_.cell.size(); ++x, ++i) {
      const std::size_t left = columns_.cell[x];
      const double u = columns_.fraction[x];
      const auto value = static_cast<double>(image[i]);
      row[static_cast<Eigen::Index>(left)] += (1 - u) * value;
      row[static_cast<Eigen::Index>(node_after(columns_, left))] += u * value;
    }
    const auto top = static_cast<Eigen::Index>(rows_.cell[y]);
    const double v = rows_.fraction[y];
    values.col(top) += (1 - v) * row;
    values.col(top + 1) += v * row;
  }
  return nodes;
}

CoarseImage::CoarseImage(const CoarseGrid& grid, std::span<const Stiffness> stiffness,
                         double level_weight)
    : grid_(grid) {
  std::vector<Eigen::Triplet<double>> entries;
  double trace = 0;
  for (std::size_t cell = 0; cell < stiffness.size(); ++cell) {
    const std::array<Eigen::Index, 4> nodes = grid.nodes_of(cell);
    const Matrix4 costs =
        element(stiffness[cell], grid.cell_px()) + levels(level_weight, grid.cell_px());
    trace += costs.trace();
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index j = 0; j < 4; ++j)
        entries.emplace_back(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)],
                             costs(i, j));
  }
  const auto count = static_cast<Eigen::Index>(grid.nodes());
  const double least = kRegularisation * trace / static_cast<double>(count);
  for (Eigen::Index i = 0; i < count; ++i) entries.emplace_back(i, i, least);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  if (!std::isfinite(trace)) return;
  factor_.compute(matrix);
  is_usable_ = factor_.info() == Eigen::Success;
}

void CoarseImage::add(const std::vector<float>& residual, std::vector<float>& image) const {
  if (!is_usable_) return;
  grid_.interpolate(factor_.solve(grid_.restricted(residual)), image);
}

}  // namespace saccade
