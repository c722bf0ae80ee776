#include "estimator/edges/least_squares/edge_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace saccade {
namespace {

/// Blocks of six unknowns.
std::vector<Eigen::Index> sixes(std::size_t blocks) {
  std::vector<Eigen::Index> begin(blocks + 1);
  for (std::size_t i = 0; i < begin.size(); ++i) begin[i] = 6 * static_cast<Eigen::Index>(i);
  return begin;
}

std::vector<std::uint32_t> blocks_from(std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint32_t> blocks(count);
  std::iota(blocks.begin(), blocks.end(), first);
  return blocks;
}

TEST(EdgeChunks, EdgesOfTheSamePartsOfThePathComeTogetherWhereverTheyStand) {
  std::vector<CoupledEdge> edges;
  for (std::size_t e = 0; e < 20; ++e) edges.push_back({e, blocks_from(e % 2 == 0 ? 0 : 40, 8)});
  const std::vector<EdgeChunk> chunks = make_chunks(edges, 5, sixes(48));
  ASSERT_EQ(chunks.size(), 2U);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(chunks[c].blocks, blocks_from(c == 0 ? 0 : 40, 8));
    ASSERT_EQ(chunks[c].edges.size(), 10U);
    for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(chunks[c].edges[k], 2 * k + c);
  }
}

TEST(EdgeChunks, OneThatIsSeenFromMuchMoreStandsAlone) {
  // Together each of the small ones would have to be multiplied over 400 blocks.
  std::vector<CoupledEdge> edges;
  for (std::size_t e = 0; e < 6; ++e) edges.push_back({e, blocks_from(0, 8)});
  edges.push_back({6, blocks_from(0, 400)});
  const std::vector<EdgeChunk> chunks = make_chunks(edges, 5, sixes(400));
  ASSERT_EQ(chunks.size(), 2U);
  EXPECT_EQ(chunks[0].edges, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(chunks[1].edges, (std::vector<std::size_t>{6}));
}

TEST(EdgeChunks, EveryEdgeIsInOneAndNoneIsTooLargeForSeveralThreads) {
  std::vector<CoupledEdge> edges;
  for (std::size_t e = 0; e < 1000; ++e)
    edges.push_back({e, blocks_from(static_cast<std::uint32_t>(e * 7919 % 23), 4)});
  std::vector<std::size_t> seen;
  for (const EdgeChunk& chunk : make_chunks(edges, 5, sixes(32))) {
    EXPECT_LE(chunk.edges.size(), EdgeChunk::kMostEdges);
    EXPECT_TRUE(std::is_sorted(chunk.blocks.begin(), chunk.blocks.end()));
    for (const std::size_t e : chunk.edges) {
      seen.push_back(e);
      EXPECT_TRUE(std::includes(chunk.blocks.begin(), chunk.blocks.end(), edges[e].blocks.begin(),
                                edges[e].blocks.end()));
    }
  }
  std::sort(seen.begin(), seen.end());
  std::vector<std::size_t> all(edges.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  EXPECT_EQ(seen, all);
}

TEST(EdgeChunks, ColumnsAndSizesFollowTheBlocks) {
  std::vector<Eigen::Index> begin = sixes(10);
  begin.push_back(begin.back() + 3);  // one block of three behind the path
  const std::vector<EdgeChunk> chunks = make_chunks({{0, {2, 3, 7, 10}}}, 5, begin);
  ASSERT_EQ(chunks.size(), 1U);
  EXPECT_EQ(chunks[0].size, 3 * 6 + 3);
  EXPECT_EQ(chunks[0].column(2), 0);
  EXPECT_EQ(chunks[0].column(3), 6);
  EXPECT_EQ(chunks[0].column(7), 12);
}

TEST(EdgeChunks, AnEdgeWithoutEventsCouplesNothing) {
  const std::vector<EdgeChunk> chunks = make_chunks({{0, {}}, {1, {}}}, 5, sixes(4));
  ASSERT_EQ(chunks.size(), 1U);
  EXPECT_EQ(chunks[0].edges.size(), 2U);
  EXPECT_EQ(chunks[0].size, 0);
}

}  // namespace
}  // namespace saccade
