#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// An edge of a bundle, by its index, and the blocks of kept unknowns that it couples, ascending.
struct CoupledEdge {
  std::size_t edge;
  std::vector<std::uint32_t> blocks;
};

/// Edges that couple much the same unknowns: eliminated together, by one product of dense matrices
/// that have columns for all these unknowns.
struct EdgeChunk {
  /// A window has a few hundred edges, which several threads share.
  static constexpr std::size_t kMostEdges = 128;

  std::vector<std::size_t> edges;
  std::vector<std::uint32_t> blocks;  ///< ascending
  std::vector<std::uint32_t> local;   ///< place of a block among them, from blocks.front() on
  Eigen::Index size = 0;              ///< unknowns of the blocks

  /// The first column of a block of the path; each has six.
  [[nodiscard]] Eigen::Index column(std::uint32_t block) const {
    return 6 * static_cast<Eigen::Index>(local[block - blocks.front()]);
  }
};

/// Every edge in one chunk, wherever it stands in the bundle. Each edge has `unknowns` of its own;
/// block i has the kept unknowns begin[i] .. begin[i + 1] - 1.
[[nodiscard]] std::vector<EdgeChunk> make_chunks(std::vector<CoupledEdge> edges,
                                                 std::size_t unknowns,
                                                 std::span<const Eigen::Index> begin);

}  // namespace saccade
