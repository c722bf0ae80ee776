#include "estimator/tracking/check/pose_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace saccade {
namespace {

/// Cells across the image, but none smaller than so many pixels, within which trackers err and maps
/// are sampled.
constexpr float kColumns = 120;
constexpr float kLeastCell_px = 2;
/// Where a block of so many cells holds no edge, the map says nothing of what is measured there.
constexpr int kBlock = 10;
/// Points of the map that are drawn, at most, and of those in view that displaced poses are tried
/// with: a fraction of so many is known to 3 %.
constexpr std::size_t kMapPoints = 4000;
constexpr std::size_t kProbes = 300;
/// With fewer points in view nothing can be said.
constexpr int kLeastEdges = 20;
/// Steep pixels of a frame, as a fraction of all.
constexpr double kSteep = 0.12;

/// Every k-th of `count` items, so that at most `most` are left.
std::size_t stride_for(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

float gradient(const ImageF& image, int x, int y) {
  const float dx = image(x + 1, y) - image(x - 1, y);
  const float dy = image(x, y + 1) - image(x, y - 1);
  const float squared = dx * dx + dy * dy;
  return std::isfinite(squared) ? squared : 0;
}

/// The six directions of a displacement that makes a pose lost, in both senses.
std::array<Twist, 12> displacements(double depth_m) {
  std::array<Twist, 12> all;
  for (int i = 0; i < 12; ++i) {
    const double size = i / 2 < 3 ? kLossDepthRatio * depth_m : kLossAngle_rad;
    all[static_cast<std::size_t>(i)] = Twist::Unit(i / 2) * (i % 2 == 0 ? size : -size);
  }
  return all;
}

}  // namespace

PoseCheck::PoseCheck(const PinholeCamera& camera)
    : camera_(camera.undistorted()),
      cells_per_px_(std::min(1 / kLeastCell_px, kColumns / static_cast<float>(camera.width))),
      columns_(static_cast<int>(std::ceil(static_cast<float>(camera.width) * cells_per_px_)) + 1),
      rows_(static_cast<int>(std::ceil(static_cast<float>(camera.height) * cells_per_px_)) + 1),
      has_measurement_(static_cast<std::size_t>(columns_ * rows_)),
      has_edge_(has_measurement_.size()) {
  std::optional<UndistortionTable> table;
  if (camera.is_distorted()) table.emplace(camera);
  cell_of_pixel_.reserve(static_cast<std::size_t>(camera.width * camera.height));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2f at =
          table ? (*table)(x, y) : Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
      cell_of_pixel_.push_back(cell_at(at.x(), at.y()));
    }
  const int block_columns = (columns_ + kBlock - 1) / kBlock;
  cells_of_block_.resize(static_cast<std::size_t>(block_columns * ((rows_ + kBlock - 1) / kBlock)));
  is_mapped_.resize(cells_of_block_.size());
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const int block = row / kBlock * block_columns + column / kBlock;
      block_of_cell_.push_back(static_cast<std::uint16_t>(block));
      ++cells_of_block_[static_cast<std::size_t>(block)];
    }
}

std::int32_t PoseCheck::cell_at(float x, float y) const {
  const float column = (x + 0.5F) * cells_per_px_;
  const float row = (y + 0.5F) * cells_per_px_;
  const bool is_inside = column >= 0 && row >= 0 &&
                         column < static_cast<float>(camera_.width) * cells_per_px_ &&
                         row < static_cast<float>(camera_.height) * cells_per_px_;
  return is_inside ? static_cast<int>(row) * columns_ + static_cast<int>(column) : kNowhere;
}

void PoseCheck::set_map(const MapPoints& map) {
  map_.clear();
  const std::size_t stride = stride_for(map.size(), kMapPoints);
  for (std::size_t i = 0; i < map.size(); i += stride) map_.add(map.x[i], map.y[i], map.z[i]);
}

void PoseCheck::Points::clear() {
  x.clear();
  y.clear();
  z.clear();
}

void PoseCheck::Points::add(float px, float py, float pz) {
  x.push_back(px);
  y.push_back(py);
  z.push_back(pz);
}

void PoseCheck::clear_measurement() {
  measured_.clear();
  std::fill(has_measurement_.begin(), has_measurement_.end(), std::uint8_t{0});
}

void PoseCheck::add_measured(std::int32_t cell) {
  if (cell == kNowhere) return;
  measured_.push_back(cell);
  has_measurement_[static_cast<std::size_t>(cell)] = 1;
}

void PoseCheck::measure(std::span<const Event> events) {
  clear_measurement();
  for (const Event& event : events)
    add_measured(cell_of_pixel_[static_cast<std::size_t>(event.y * camera_.width + event.x)]);
}

void PoseCheck::measure(const ImageF& log_intensity) {
  clear_measurement();
  std::vector<float> steepness;
  for (int y = 1; y + 1 < log_intensity.height(); ++y)
    for (int x = 1; x + 1 < log_intensity.width(); ++x)
      steepness.push_back(gradient(log_intensity, x, y));
  if (steepness.empty()) return;
  const auto rank = static_cast<std::size_t>((1 - kSteep) * static_cast<double>(steepness.size()));
  std::vector<float> sorted = steepness;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank),
                   sorted.end());
  const float least = sorted[rank];
  std::size_t i = 0;
  for (int y = 1; y + 1 < log_intensity.height(); ++y)
    for (int x = 1; x + 1 < log_intensity.width(); ++x, ++i)
      if (steepness[i] > least) add_measured(cell_at(static_cast<float>(x), static_cast<float>(y)));
}

PoseEvidence PoseCheck::evaluate(const Rigid3& map_from_camera) {
  PoseEvidence evidence;
  const Rigid3 camera_from_map = map_from_camera.inverse();
  draw_map(camera_from_map, evidence);
  if (evidence.edges < kLeastEdges) return {};
  compare(evidence);
  evidence.edges_confirmed = confirmed_edges(camera_from_map);
  for (const Twist& displacement : displacements(evidence.depth_m))
    evidence.confirmed_if_wrong = std::max(
        evidence.confirmed_if_wrong, confirmed_edges(Rigid3::exp(displacement) * camera_from_map));
  return evidence;
}

void PoseCheck::project(const Points& points, const Rigid3& camera_from_map) {
  const Eigen::Matrix3f r = camera_from_map.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = camera_from_map.translation().cast<float>();
  const float scale = cells_per_px_;
  const float fx = scale * static_cast<float>(camera_.fx),
              fy = scale * static_cast<float>(camera_.fy);
  const float cx = scale * (static_cast<float>(camera_.cx) + 0.5F);
  const float cy = scale * (static_cast<float>(camera_.cy) + 0.5F);
  const float width = scale * static_cast<float>(camera_.width);
  const float height = scale * static_cast<float>(camera_.height);
  const int columns = columns_;
  const std::size_t count = points.size();
  cells_.resize(count);
  inverse_depths_.resize(count);
  const float* const px = points.x.data();
  const float* const py = points.y.data();
  const float* const pz = points.z.data();
  std::int32_t* const cells = cells_.data();
  float* const inverse_depths = inverse_depths_.data();
  // As cell_at(), without branches: the compiler takes several points at a time.
  for (std::size_t i = 0; i < count; ++i) {
    const float x = r(0, 0) * px[i] + r(0, 1) * py[i] + r(0, 2) * pz[i] + t.x();
    const float y = r(1, 0) * px[i] + r(1, 1) * py[i] + r(1, 2) * pz[i] + t.y();
    const float z = r(2, 0) * px[i] + r(2, 1) * py[i] + r(2, 2) * pz[i] + t.z();
    const float inverse_depth = 1 / z;
    const float column = fx * x * inverse_depth + cx;
    const float row = fy * y * inverse_depth + cy;
    const bool is_inside = (z > 0) & (column >= 0) & (row >= 0) & (column < width) & (row < height);
    const int cell = static_cast<int>(is_inside ? row : 0.0F) * columns +
                     static_cast<int>(is_inside ? column : 0.0F);
    cells[i] = is_inside ? cell : kNowhere;
    inverse_depths[i] = inverse_depth;
  }
}

void PoseCheck::draw_map(const Rigid3& camera_from_map, PoseEvidence& evidence) {
  std::fill(has_edge_.begin(), has_edge_.end(), std::uint8_t{0});
  std::fill(is_mapped_.begin(), is_mapped_.end(), std::uint8_t{0});
  project(map_, camera_from_map);
  double inverse_depths = 0;
  for (std::size_t i = 0; i < map_.size(); ++i) {
    if (cells_[i] == kNowhere) continue;
    const auto index = static_cast<std::size_t>(cells_[i]);
    evidence.chance += has_edge_[index] == 0 ? 1 : 0;
    has_edge_[index] = 1;
    is_mapped_[block_of_cell_[index]] = 1;
    inverse_depths += static_cast<double>(inverse_depths_[i]);
    ++evidence.edges;
  }
  const auto visible = static_cast<std::size_t>(evidence.edges);
  evidence.depth_m = evidence.edges / inverse_depths;
  probes_.clear();
  const std::size_t stride = stride_for(visible, kProbes);
  std::size_t skipped = stride - 1;
  for (std::size_t i = 0; i < map_.size(); ++i) {
    if (cells_[i] == kNowhere) continue;
    if (++skipped < stride) continue;
    skipped = 0;
    probes_.add(map_.x[i], map_.y[i], map_.z[i]);
  }
}

void PoseCheck::compare(PoseEvidence& evidence) const {
  double area = 0;
  for (std::size_t block = 0; block < is_mapped_.size(); ++block)
    area += is_mapped_[block] != 0 ? cells_of_block_[block] : 0;
  int explained = 0;
  for (const std::int32_t cell : measured_) {
    const auto index = static_cast<std::size_t>(cell);
    evidence.measured += is_mapped_[block_of_cell_[index]];
    explained += has_edge_[index];
  }
  evidence.chance /= area;
  const auto measured = static_cast<double>(evidence.measured);
  evidence.explained = measured > 0 ? explained / measured : evidence.chance;
  evidence.in_map = measured_.empty() ? 0 : measured / static_cast<double>(measured_.size());
}

double PoseCheck::confirmed_edges(const Rigid3& camera_from_map) {
  project(probes_, camera_from_map);
  int seen = 0, visible = 0;
  for (const std::int32_t cell : cells_) {
    if (cell == kNowhere) continue;
    ++visible;
    seen += has_measurement_[static_cast<std::size_t>(cell)];
  }
  // Of a few edges all may be seen by chance.
  return visible >= kLeastEdges / 2 ? static_cast<double>(seen) / visible : 0;
}

}  // namespace saccade
