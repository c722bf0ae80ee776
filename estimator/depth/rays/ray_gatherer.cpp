#include "estimator/depth/rays/ray_gatherer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace saccade {
namespace {

constexpr std::size_t kCoefficients = 24;
/// Margin on the motion within a slice, which is approximated as uniform.
constexpr float kSlack_px = 0.25F;

using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(float))));

Lanes magnitude(const Lanes& v) { return v < 0 ? -v : v; }

/// Homogeneous pixels and their change per second.
struct Projected {
  Lanes x, y, z;
};

/// (M p - rho c) of every lane; `c` points at nine rows of M by columns and three of c.
Projected project(const std::array<Lanes, kCoefficients>& k, std::size_t first,
                  const Eigen::Vector2f& pixel, float rho) {
  const auto row = [&](std::size_t i) -> Lanes {
    return k[first + 3 * i] * pixel.x() + k[first + 3 * i + 1] * pixel.y() + k[first + 3 * i + 2] -
           k[first + 9 + i] * rho;
  };
  return {row(0), row(1), row(2)};
}

/// Bounding box, in cells, of the strip of an edgel during each of kLanes slices.
struct Boxes {
  alignas(64) std::array<std::int32_t, kLanes> left, right, top, bottom;
  alignas(64) std::array<std::int32_t, kLanes> is_on;  ///< events there are ON
  alignas(64) std::array<std::int32_t, kLanes> is_ahead;
  alignas(64) std::array<float, kLanes> slice_motion_px;
};

/// The cell of a coordinate; coordinates outside the grid belong to its border.
Ints cell_of(const Lanes& px, int cells) {
  const auto last = static_cast<float>(cells - 1);
  Lanes cell = (px + EventRays::kCellOrigin_px) * (1.F / EventRays::kCell_px);
  cell = cell > 0 ? cell : Lanes{};
  cell = cell < last ? cell : Lanes{} + last;
  return __builtin_convertvector(cell, Ints);
}

template <class Vector, class Array>
void store(const Vector& lanes, Array& array) {
  static_assert(sizeof(lanes) == sizeof(array));
  std::memcpy(array.data(), &lanes, sizeof(lanes));
}

}  // namespace

void RayNeighbourhood::reserve(std::size_t size) {
  const std::size_t padded = padded_to_lanes(size);
  if (event.size() >= padded) return;
  event.resize(2 * padded);
  for (auto* array : {&across, &along, &parallax, &polarity}) array->resize(2 * padded);
}

void RayNeighbourhood::pad() {
  reserve(count);
  for (std::size_t i = count; i < padded(); ++i)
    for (auto* array : {&across, &along, &parallax, &polarity}) (*array)[i] = 0;
}

RayGatherer::RayGatherer(const EventRays& rays, const GatherWindow& window)
    : rays_(rays),
      radius_px_(static_cast<float>(window.radius_px)),
      half_length_px_(static_cast<float>(window.half_length_px)),
      coefficients_(kCoefficients) {
  const auto slices = rays.slices();
  for (auto& c : coefficients_) c.assign(padded_to_lanes(slices.size()), 0.F);
  slice_motion_px_.resize(padded_to_lanes(slices.size()));
  for (std::size_t s = 0; s < slices.size(); ++s)
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      for (int j = 0; j < 3; ++j) {
        const std::size_t at = 3 * row + static_cast<std::size_t>(j);
        coefficients_[at][s] = slices[s].pixel_from_reference(i, j);
        coefficients_[12 + at][s] = slices[s].pixel_rate(i, j);
      }
      coefficients_[9 + row][s] = slices[s].centre_term(i);
      coefficients_[21 + row][s] = slices[s].centre_rate(i);
    }
}

namespace {

/// The box is that of the strip's corners in the middle of the slice, grown by the motion within
/// half a slice.
Boxes boxes_of(const std::vector<std::vector<float>>& coefficients, std::size_t block,
               const EventRays& rays, const Edgel& edge, float radius_px, float half_length_px) {
  std::array<Lanes, kCoefficients> k;
  for (std::size_t i = 0; i < kCoefficients; ++i)
    std::memcpy(&k[i], coefficients[i].data() + block, sizeof(Lanes));
  const float rho = edge.inverse_depth;
  const Projected h = project(k, 0, edge.pixel, rho);
  const Projected beside = project(k, 0, edge.pixel + edge.tangent(), rho);
  const Projected rate = project(k, 12, edge.pixel, rho);
  const Lanes per_z = 1.F / h.z, beside_per_z = 1.F / beside.z;
  const Lanes x = h.x * per_z, y = h.y * per_z;
  const Lanes motion_x = (rate.x - x * rate.z) * per_z, motion_y = (rate.y - y * rate.z) * per_z;
  const Lanes along_x = beside.x * beside_per_z - x, along_y = beside.y * beside_per_z - y;
  const float half_slice_s = rays.slice_length_s() / 2;
  const Lanes reach_x = magnitude(along_x) * half_length_px + magnitude(along_y) * radius_px +
                        magnitude(motion_x) * half_slice_s + kSlack_px;
  const Lanes reach_y = magnitude(along_y) * half_length_px + magnitude(along_x) * radius_px +
                        magnitude(motion_y) * half_slice_s + kSlack_px;
  // A pixel that the edge passes over gets brighter where the edge moves against its normal.
  const Lanes sweep = along_y * motion_x - along_x * motion_y;
  const Ints is_on = sweep < 0;
  const Ints is_ahead = (h.z > 0) & (beside.z > 0);
  Boxes boxes;
  store(cell_of(x - reach_x, rays.columns()), boxes.left);
  store(cell_of(x + reach_x, rays.columns()), boxes.right);
  store(cell_of(y - reach_y, rays.rows()), boxes.top);
  store(cell_of(y + reach_y, rays.rows()), boxes.bottom);
  store(is_on, boxes.is_on);
  store(is_ahead, boxes.is_ahead);
  store(magnitude(sweep) * rays.slice_length_s(), boxes.slice_motion_px);
  return boxes;
}

}  // namespace

void RayGatherer::gather(const SliceRange& slices, const Edgel& edge, RayNeighbourhood& near) {
  runs_.clear();
  count_ = 0;
  const int lanes = static_cast<int>(kLanes);
  int next = slices.first;
  for (int block = next / lanes * lanes; block < slices.last; block += lanes) {
    const Boxes boxes = boxes_of(coefficients_, static_cast<std::size_t>(block), rays_, edge,
                                 radius_px_, half_length_px_);
    std::copy(boxes.slice_motion_px.begin(), boxes.slice_motion_px.end(),
              slice_motion_px_.begin() + block);
    for (; next < std::min(slices.last, block + lanes); next += slices.stride) {
      const auto lane = static_cast<std::size_t>(next - block);
      if (boxes.is_ahead[lane] == 0) continue;
      const bool is_on = boxes.is_on[lane] != 0;
      for (int row = boxes.top[lane]; row <= boxes.bottom[lane]; ++row)
        add_run(rays_.cell_begin(next, is_on, boxes.left[lane], row),
                rays_.cell_begin(next, is_on, boxes.right[lane] + 1, row), is_on);
    }
  }
  load();
  select(edge, near);
}

void RayGatherer::add_run(std::uint32_t begin, std::uint32_t end, bool is_on) {
  if (begin == end) return;
  __builtin_prefetch(&rays_.line[begin]);
  runs_.push_back({begin, end, is_on ? kOn : 0});
  count_ += end - begin;
}

void RayGatherer::load() {
  if (line_.size() < count_) {
    line_.resize(2 * count_);
    event_.resize(2 * count_);
    is_near_.resize(2 * count_);
    chosen_.resize(2 * count_);
  }
  std::size_t at = 0;
  for (const Run& run : runs_)
    for (std::uint32_t i = run.begin; i < run.end; ++i, ++at) {
      line_[at] = rays_.line[i];
      event_[at] = i | run.polarity;
    }
}

void RayGatherer::select(const Edgel& edge, RayNeighbourhood& near) {
  const float rho = edge.inverse_depth;
  const float nx = edge.normal.x(), ny = edge.normal.y();
  const float ex = edge.pixel.x(), ey = edge.pixel.y();
  for (std::size_t i = 0; i < count_; ++i) {
    const float dx = line_[i].ax + line_[i].bx * rho - ex;
    const float dy = line_[i].ay + line_[i].by * rho - ey;
    is_near_[i] = (std::abs(nx * dx + ny * dy) <= radius_px_) &
                  (std::abs(nx * dy - ny * dx) <= half_length_px_);
  }
  // Without branches, since whether an event is near cannot be predicted.
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    chosen_[chosen] = static_cast<std::uint32_t>(i);
    chosen += is_near_[i];
  }
  near.count = chosen;
  near.pad();
  for (std::size_t k = 0; k < chosen; ++k) {
    const std::size_t i = chosen_[k];
    const RayLine& line = line_[i];
    const float dx = line.ax + line.bx * rho - ex;
    const float dy = line.ay + line.by * rho - ey;
    near.event[k] = event_[i] & ~kOn;
    near.across[k] = nx * dx + ny * dy;
    near.along[k] = nx * dy - ny * dx;
    near.parallax[k] = nx * line.bx + ny * line.by;
    near.polarity[k] = (event_[i] & kOn) != 0 ? 1.F : -1.F;
  }
}

}  // namespace saccade
