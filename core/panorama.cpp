#include "core/panorama.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/process/parallel.h"

namespace saccade {
namespace {

constexpr double kPi = std::numbers::pi;

/// Even, with no other prime factors than 2, 3 and 5.
bool is_quick(int size) {
  if (size % 2 != 0) return false;
  for (const int factor : {2, 3, 5})
    while (size % factor == 0) size /= factor;
  return size == 1;
}

int quick_size(int least) {
  while (!is_quick(least)) ++least;
  return least;
}

/// A run of columns or rows.
struct Range {
  int begin = 0, size = 0;
};

/// The shortest run, around the circle, that holds all marked ones.
Range shortest_run(const std::vector<bool>& marked) {
  const int count = static_cast<int>(marked.size());
  Range gap;
  for (int begin = 0; begin < count; ++begin) {
    int size = 0;
    while (size < count && !marked[static_cast<std::size_t>((begin + size) % count)]) ++size;
    if (size > gap.size) gap = {begin, size};
  }
  return {(gap.begin + gap.size) % count, count - gap.size};
}

/// A range of quick size around another, within [0, whole) unless it goes around.
Range widened(const Range& range, int whole, bool around) {
  const int size = std::min(quick_size(range.size), whole);
  int begin = range.begin - (size - range.size) / 2;
  begin = around ? (begin % whole + whole) % whole : std::clamp(begin, 0, whole - size);
  return {size == whole ? 0 : begin, size};
}

}  // namespace

Eigen::Vector3d Panorama::direction(double x, double y) const {
  const double longitude = kPi - (left + x + 0.5) / pixels_per_radian();
  const double latitude = kPi / 2 - (top + y + 0.5) / pixels_per_radian();
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
          std::sin(latitude)};
}

Eigen::Vector2d Panorama::pixel(const Eigen::Vector3d& direction) const {
  const double longitude = std::atan2(direction.y(), direction.x());
  const double latitude = std::atan2(direction.z(), std::hypot(direction.x(), direction.y()));
  const double x = (kPi - longitude) * pixels_per_radian() - 0.5 - left;
  const double y = (kPi / 2 - latitude) * pixels_per_radian() - 0.5 - top;
  const double revolutions = std::round((x - 0.5 * (width - 1)) / around);
  return {x - revolutions * around, y};
}

double Panorama::row_width(int y) const {
  const double latitude = kPi / 2 - (top + y + 0.5) / pixels_per_radian();
  return std::max(std::cos(latitude), std::sin(0.5 / pixels_per_radian()));
}

double Panorama::solid_angle(int y) const {
  const double above = kPi / 2 - (top + y) / pixels_per_radian();
  return (std::sin(above) - std::sin(above - 1 / pixels_per_radian())) / pixels_per_radian();
}

void Panorama::check(const std::string& location) const {
  if (around < 4 || around % 2 != 0)
    throw InputError(location, "around must be an even number of pixels, 4 or more");
  if (left < 0 || left >= around || width < 2 || width > around)
    throw InputError(location, "left and width must name 2 or more of the columns around");
  if (top < 0 || height < 2 || height > around / 2 - top)
    throw InputError(location, "top and height must name 2 or more rows of half as many as around");
}

FieldOfView::FieldOfView(const PinholeCamera& camera)
    : camera_(camera), low_(0, 0), high_(camera.width - 1, camera.height - 1) {
  const auto hold = [&](double x, double y) {
    const Eigen::Vector2d pixel = camera.undistort({x, y});
    low_ = low_.cwiseMin(pixel);
    high_ = high_.cwiseMax(pixel);
  };
  for (int x = 0; x < camera.width; ++x)
    for (const int y : {0, camera.height - 1}) hold(x, y);
  for (int y = 0; y < camera.height; ++y)
    for (const int x : {0, camera.width - 1}) hold(x, y);
}

bool FieldOfView::sees(const Eigen::Vector3d& direction) const {
  if (!(direction.z() > 0)) return false;
  const Eigen::Vector2d pixel = camera_.project(direction);
  // Far outside the image the lens's polynomials mean nothing.
  if (!((pixel.array() >= low_.array()).all() && (pixel.array() <= high_.array()).all()))
    return false;
  return camera_.contains(camera_.distort(pixel));
}

double FieldOfView::solid_angle() const {
  // d Omega = dx dy / |(x, y, 1)|^3, over the undistorted pixels that fall on the sensor.
  double sum = 0;
  for (int y = static_cast<int>(low_.y()); y < high_.y(); ++y)
    for (int x = static_cast<int>(low_.x()); x < high_.x(); ++x) {
      const Eigen::Vector2d pixel(x + 0.5, y + 0.5);
      if (!camera_.contains(camera_.distort(pixel))) continue;
      sum += 1 / (camera_.fx * camera_.fy * std::pow(camera_.ray(pixel).norm(), 3));
    }
  return sum;
}

double FieldOfView::horizontal_angle() const {
  const double middle = 0.5 * (camera_.height - 1);
  const Eigen::Vector3d left = camera_.ray(camera_.undistort({0, middle}));
  const Eigen::Vector3d right = camera_.ray(camera_.undistort({camera_.width - 1.0, middle}));
  return std::acos(std::clamp(left.normalized().dot(right.normalized()), -1.0, 1.0));
}

std::vector<Eigen::Matrix3d> thinned(std::span<const Eigen::Matrix3d> rotations, double angle) {
  std::vector<Eigen::Matrix3d> kept;
  for (const Eigen::Matrix3d& one : rotations) {
    // trace R = 1 + 2 cos(angle)
    if (kept.empty() || (kept.back().transpose() * one).trace() < 1 + 2 * std::cos(angle))
      kept.push_back(one);
  }
  if (!rotations.empty()) kept.push_back(rotations.back());
  return kept;
}

ImageU8 seen_by(const FieldOfView& camera, std::span<const Eigen::Matrix3d> world_from_camera,
                const Panorama& panorama) {
  ImageU8 seen(panorama.width, panorama.height);
  const auto is_seen = [&](const Eigen::Vector3d& direction) {
    return std::any_of(world_from_camera.begin(), world_from_camera.end(),
                       [&](const Eigen::Matrix3d& rotation) {
                         return rotation.col(2).dot(direction) > 0 &&
                                camera.sees(rotation.transpose() * direction);
                       });
  };
  parallel_for(static_cast<std::size_t>(panorama.height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < panorama.width; ++x) seen(x, y) = is_seen(panorama.direction(x, y)) ? 1 : 0;
  });
  return seen;
}

int pixels_around(double pixels_per_radian) {
  SACCADE_CHECK(pixels_per_radian > 0);
  int quarter = static_cast<int>(std::ceil(kPi / 2 * pixels_per_radian - 1e-9));
  quarter = std::max(quarter, 1);
  // Half of it, the rows, must be even, too.
  while (!is_quick(2 * quarter)) ++quarter;
  return 4 * quarter;
}

Panorama panorama_around(const FieldOfView& camera,
                         std::span<const Eigen::Matrix3d> world_from_camera,
                         double pixels_per_radian) {
  constexpr int kCoarse = 8;  // pixels that are left or taken as one
  const int around = pixels_around(pixels_per_radian);
  const Panorama coarse = Panorama::sphere(std::max(around / kCoarse / 2 * 2, 4));
  const double scale = static_cast<double>(around) / coarse.around;
  const ImageU8 seen =
      seen_by(camera, thinned(world_from_camera, 0.5 / coarse.pixels_per_radian()), coarse);
  std::vector<bool> columns(static_cast<std::size_t>(coarse.width));
  int first_row = coarse.height, last_row = -1;
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      if (seen(x, y) == 0) continue;
      columns[static_cast<std::size_t>(x)] = true;
      first_row = std::min(first_row, y);
      last_row = std::max(last_row, y);
    }
  if (last_row < 0) return Panorama::sphere(around);
  const Range run = shortest_run(columns);
  const auto size = [&](int count) { return static_cast<int>(std::ceil(scale * (count + 2))); };
  const bool is_whole = size(run.size + 2) >= around;
  const Range x =
      is_whole ? Range{0, around}
               : widened({static_cast<int>(scale * (run.begin - 1)), size(run.size)}, around, true);
  const Range y = widened({static_cast<int>(scale * (first_row - 1)),
                           std::min(size(last_row - first_row + 1), around / 2)},
                          around / 2, false);
  return {around, x.begin, y.begin, x.size, y.size};
}

}  // namespace saccade
