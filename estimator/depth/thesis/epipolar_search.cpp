#include "estimator/depth/thesis/epipolar_search.h"

#include <cmath>
#include <cstddef>

namespace saccade {
namespace {

/// An increment below kConvergedPx ends the search; one above kDivergedPx after the last iteration
/// means that it did not converge [px].
constexpr double kConvergedPx = 0.01;
constexpr double kDivergedPx = 0.2;

/// The square of 2 r + 1 pixels around `centre`: one set of bilinear weights serves all of them.
void read_square(const ImageF& frame, const Eigen::Vector2d& centre, int radius,
                 Eigen::VectorXf& out) {
  const int size = 2 * radius + 1;
  const auto left = static_cast<int>(std::floor(centre.x()));
  const auto top = static_cast<int>(std::floor(centre.y()));
  const auto fx = static_cast<float>(centre.x() - left);
  const auto fy = static_cast<float>(centre.y() - top);
  const float w00 = (1 - fx) * (1 - fy), w10 = fx * (1 - fy), w01 = (1 - fx) * fy, w11 = fx * fy;
  for (int row = 0; row < size; ++row) {
    const float* upper = &frame(left - radius, top - radius + row);
    const float* lower = upper + frame.width();
    float* target = out.data() + static_cast<std::ptrdiff_t>(row) * size;
    for (int i = 0; i < size; ++i)
      target[i] = w00 * upper[i] + w10 * upper[i + 1] + w01 * lower[i] + w11 * lower[i + 1];
  }
}

/// To zero mean and unit norm; the norm before.
float normalise(Eigen::VectorXf& values) {
  values.array() -= values.mean();
  const float norm = values.norm();
  if (norm > 0) values /= norm;
  return norm;
}

/// True where the square and the pixels that its bilinear reads touch lie within the frame.
bool is_within(const ImageF& frame, const Eigen::Vector2d& centre, int radius) {
  return centre.x() >= radius && centre.y() >= radius && centre.x() < frame.width() - 1 - radius &&
         centre.y() < frame.height() - 1 - radius;
}

}  // namespace

bool FramePatch::fits(const ImageF& frame, const Eigen::Vector2d& centre, int radius) {
  return is_within(frame, centre, radius + 1);
}

FramePatch::FramePatch(const ImageF& frame, const Eigen::Vector2d& centre, int radius) {
  const Eigen::Index size = 2 * radius + 1;
  values_.resize(size * size);
  dx_.resize(size * size);
  dy_.resize(size * size);
  read_square(frame, centre, radius, values_);
  Eigen::VectorXf before(size * size);
  read_square(frame, centre + Eigen::Vector2d(1, 0), radius, dx_);
  read_square(frame, centre - Eigen::Vector2d(1, 0), radius, before);
  dx_ = (dx_ - before) / 2;
  read_square(frame, centre + Eigen::Vector2d(0, 1), radius, dy_);
  read_square(frame, centre - Eigen::Vector2d(0, 1), radius, before);
  dy_ = (dy_ - before) / 2;
  const float norm = normalise(values_);
  if (!(norm > 0)) return;
  for (Eigen::VectorXf* derivative : {&dx_, &dy_}) {
    derivative->array() -= derivative->mean();
    *derivative /= norm;
  }
}

SearchResult search_along(const FramePatch& reference, const ImageF& frame,
                          const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                          const SearchOptions& options) {
  SearchResult result;
  const Eigen::Vector2f line = direction.cast<float>();
  const Eigen::VectorXf jacobian = line.x() * reference.dx() + line.y() * reference.dy();  // (5.4)
  const float hessian = jacobian.squaredNorm();
  const float all = reference.dx().squaredNorm() + reference.dy().squaredNorm();
  if (!(hessian > static_cast<float>(options.min_alignment) * all)) {
    result.status = SearchStatus::kNoGradient;
    return result;
  }
  Eigen::VectorXf patch(reference.values().size());
  double increment_px = kDivergedPx;
  for (int i = 0; i <= options.iterations; ++i) {
    const Eigen::Vector2d position = start + result.shift_px * direction;
    if (!is_within(frame, position, options.patch_radius_px)) {
      result.status = SearchStatus::kOutside;
      return result;
    }
    read_square(frame, position, options.patch_radius_px, patch);
    normalise(patch);
    result.correlation = static_cast<double>(patch.dot(reference.values()));
    if (std::abs(increment_px) < kConvergedPx || i == options.iterations) break;
    increment_px = -static_cast<double>(jacobian.dot(patch - reference.values()) / hessian);
    result.shift_px += increment_px;
    if (std::abs(result.shift_px) > options.max_shift_px) return result;
  }
  if (std::abs(increment_px) > kDivergedPx) return result;
  result.status = result.correlation < options.min_correlation ? SearchStatus::kDifferent
                                                               : SearchStatus::kFound;
  return result;
}

}  // namespace saccade
