#include "estimator/edges/least_squares/edge_chunks.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace saccade {
namespace {

/// Blocks by eights: coarse enough that edges of the same views agree, finer than keyframes are
/// apart.
std::vector<std::uint32_t> stretches_of(const CoupledEdge& edge) {
  constexpr std::uint32_t kStretch = 8;
  std::vector<std::uint32_t> stretches;
  for (const std::uint32_t block : edge.blocks)
    if (stretches.empty() || stretches.back() != block / kStretch)
      stretches.push_back(block / kStretch);
  return stretches;
}

/// What a chunk that couples `blocks` blocks takes, whose edges have `unknowns` of their own: its
/// product of dense matrices, and to clear, read and add a matrix of its size, which by the bytes
/// that are moved is about as long as a product of fifty rows. In rows times squared blocks.
double chunk_cost(std::size_t unknowns, std::size_t blocks) {
  constexpr double kRowsToAdd = 50;
  const auto size = static_cast<double>(blocks);
  return (static_cast<double>(unknowns) + kRowsToAdd) * size * size;
}

void index_blocks(EdgeChunk& chunk, std::span<const Eigen::Index> begin) {
  if (chunk.blocks.empty()) return;
  chunk.local.assign(chunk.blocks.back() - chunk.blocks.front() + 1, 0);
  for (std::size_t k = 0; k < chunk.blocks.size(); ++k)
    chunk.local[chunk.blocks[k] - chunk.blocks.front()] = static_cast<std::uint32_t>(k);
  for (const std::uint32_t block : chunk.blocks) chunk.size += begin[block + 1] - begin[block];
}

}  // namespace

std::vector<EdgeChunk> make_chunks(std::vector<CoupledEdge> edges, std::size_t unknowns,
                                   std::span<const Eigen::Index> begin) {
  // Those that are seen from the same stretches of the path come together.
  std::vector<std::pair<std::vector<std::uint32_t>, CoupledEdge>> sorted;
  sorted.reserve(edges.size());
  for (CoupledEdge& edge : edges) {
    std::vector<std::uint32_t> stretches = stretches_of(edge);
    sorted.emplace_back(std::move(stretches), std::move(edge));
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<EdgeChunk> chunks;
  std::vector<std::uint32_t> all;
  // Whether it costs no more in the last chunk, which then couples `all`, than by itself.
  const auto fits = [&](const CoupledEdge& edge) {
    if (chunks.empty() || chunks.back().edges.size() >= EdgeChunk::kMostEdges) return false;
    const EdgeChunk& chunk = chunks.back();
    all.clear();
    std::set_union(chunk.blocks.begin(), chunk.blocks.end(), edge.blocks.begin(), edge.blocks.end(),
                   std::back_inserter(all));
    const std::size_t before = chunk.edges.size() * unknowns;
    return chunk_cost(before + unknowns, all.size()) <=
           chunk_cost(before, chunk.blocks.size()) + chunk_cost(unknowns, edge.blocks.size());
  };
  for (auto& [stretches, edge] : sorted) {
    if (fits(edge))
      chunks.back().blocks = all;
    else
      chunks.push_back({{}, std::move(edge.blocks), {}, 0});
    chunks.back().edges.push_back(edge.edge);
  }
  for (EdgeChunk& chunk : chunks) index_blocks(chunk, begin);
  return chunks;
}

}  // namespace saccade
