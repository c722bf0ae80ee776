#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace saccade {

/// What a slope g of the image costs, g^T M g: the tensor M of a cell, summed up over what lies in it
/// [1 / (log units / px)^2].
struct Stiffness {
  float xx = 0, xy = 0, yy = 0;

  Stiffness& operator+=(const Stiffness& other) {
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
  }
};

/// Cells of four pixels a side, larger ones in images of more than 1.6 million pixels. Their corners are the nodes
/// of images that are bilinear in between: smooth enough for what pixels tell by their slopes, and few enough for
/// a direct solution.
class CoarseGrid {
 public:
  /// `wraps`: the cells of the last column end at the nodes of the first one. At least two pixels a side.
  CoarseGrid(int width, int height, bool wraps);

  [[nodiscard]] std::size_t cells() const { return columns_.cells * rows_.cells; }
  [[nodiscard]] std::size_t nodes() const { return columns_.nodes * rows_.nodes; }
  [[nodiscard]] std::size_t cell_of(int x, int y) const {
    return rows_.cell[static_cast<std::size_t>(y)] * columns_.cells +
           columns_.cell[static_cast<std::size_t>(x)];
  }

  /// The nodes of a cell: upper left, upper right, lower left and lower right.
  [[nodiscard]] std::array<Eigen::Index, 4> nodes_of(std::size_t cell) const;
  /// Size of a cell [px].
  [[nodiscard]] Eigen::Vector2d cell_px() const { return {columns_.cell_px, rows_.cell_px}; }

  /// Adds to each pixel what it has of the nodes' values.
  void interpolate(const Eigen::VectorXd& nodes, std::vector<float>& image) const;
  /// The transpose of it.
  [[nodiscard]] Eigen::VectorXd restricted(const std::vector<float>& image) const;

 private:
  /// Of the columns or of the rows.
  struct Axis {
    std::size_t cells = 0, nodes = 0;
    double cell_px = 0;
    std::vector<std::size_t> cell;  ///< of each pixel
    std::vector<double> fraction;   ///< of the way from the node before it to the next
  };
  [[nodiscard]] static Axis axis(int pixels, int cell_px, bool wraps);
  [[nodiscard]] std::size_t node_after(const Axis& axis, std::size_t cell) const {
    return cell + 1 == axis.nodes ? 0 : cell + 1;
  }

  Axis columns_, rows_;
};

/// The coarse-grid correction of a preconditioner: the image of a coarse grid that minimises half of what its slopes and
/// levels cost, less its product with a residual. Finite elements, solved directly.
class CoarseImage {
 public:
  /// `stiffness` of every cell of the grid, which outlives this; `level_weight` of a pixel's square.
  CoarseImage(const CoarseGrid& grid, std::span<const Stiffness> stiffness,
              double level_weight = 0);

  /// Adds the solution of a residual to an image; nothing where the costs are not finite or leave it undetermined.
  void add(const std::vector<float>& residual, std::vector<float>& image) const;

 private:
  const CoarseGrid& grid_;
  bool is_usable_ = false;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace saccade
