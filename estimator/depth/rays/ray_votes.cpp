#include "estimator/depth/rays/ray_votes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade {
namespace {

constexpr std::size_t kBlock = 256;

/// Of a block of rays: index of the nearest pixel (-1 outside) and the vote.
struct Block {
  std::array<int, kBlock> pixel;
  std::array<float, kBlock> vx, vy;
};

void project(const EventRays& rays, std::size_t begin, std::size_t count, float rho, int width,
             int height, Block& block) {
  const RayLine* line = rays.line.data() + begin;
  const auto right = static_cast<float>(width);
  const auto bottom = static_cast<float>(height);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = line[i].ax + line[i].bx * rho + 0.5F;
    const float y = line[i].ay + line[i].by * rho + 0.5F;
    const bool inside = (x >= 0) & (y >= 0) & (x < right) & (y < bottom);
    // The conversion must be defined where the ray leaves the image, too.
    const auto column = static_cast<int>(inside ? x : 0.F);
    const auto row = static_cast<int>(inside ? y : 0.F);
    block.pixel[i] = inside ? row * width + column : -1;
  }
}

void orient(const EventRays& rays, std::size_t begin, std::size_t count, float rho, Block& block) {
  const RayGradient* gradient = rays.gradient.data() + begin;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = gradient[i].qax + gradient[i].qbx * rho;
    const float y = gradient[i].qay + gradient[i].qby * rho;
    const float scale = 1 / std::sqrt(x * x + y * y + 1e-12F);
    block.vx[i] = x * scale;
    block.vy[i] = y * scale;
  }
}

}  // namespace

void vote_vectors(const EventRays& rays, std::size_t begin, std::size_t end, float inverse_depth,
                  Image<Eigen::Vector2f>& votes) {
  Block block;
  for (std::size_t at = begin; at < end; at += kBlock) {
    const std::size_t count = std::min(kBlock, end - at);
    project(rays, at, count, inverse_depth, votes.width(), votes.height(), block);
    orient(rays, at, count, inverse_depth, block);
    for (std::size_t i = 0; i < count; ++i)
      if (block.pixel[i] >= 0)
        votes.data()[block.pixel[i]] += Eigen::Vector2f(block.vx[i], block.vy[i]);
  }
}

void vote_bilinear(const EventRays& rays, std::size_t begin, std::size_t end, float inverse_depth,
                   ImageF& votes) {
  for (std::size_t i = begin; i < end; ++i) {
    const float x = rays.line[i].ax + rays.line[i].bx * inverse_depth;
    const float y = rays.line[i].ay + rays.line[i].by * inverse_depth;
    if (is_inside(votes, x, y)) splat(votes, x, y, 1.F);
  }
}

}  // namespace saccade
