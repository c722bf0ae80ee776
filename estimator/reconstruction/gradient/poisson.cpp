#include "estimator/reconstruction/gradient/poisson.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace saccade {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ImageMap = Eigen::Map<Matrix>;

/// Orthonormal DST-I: symmetric and its own inverse.
Matrix sine_matrix(int size) {
  Matrix m(size, size);
  const double scale = std::sqrt(2.0 / (size + 1));
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k)
      m(i, k) = static_cast<float>(scale *
                                   std::sin(std::numbers::pi * (i + 1.0) * (k + 1.0) / (size + 1)));
  return m;
}

/// Orthonormal DCT-II, rows are the basis.
Matrix cosine_matrix(int size) {
  Matrix m(size, size);
  for (int k = 0; k < size; ++k)
    for (int i = 0; i < size; ++i)
      m(k, i) = static_cast<float>(std::sqrt((k == 0 ? 1.0 : 2.0) / size) *
                                   std::cos(std::numbers::pi * k * (i + 0.5) / size));
  return m;
}

/// Orthonormal Hartley transform, cos + sin: symmetric and its own inverse.
Matrix hartley_matrix(int size) {
  Matrix m(size, size);
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k) {
      // i k modulo the size, so that the angle is exact.
      const auto revolutions = static_cast<double>(static_cast<long>(i) * k % size) / size;
      const double angle = 2 * std::numbers::pi * revolutions;
      m(i, k) = static_cast<float>((std::cos(angle) + std::sin(angle)) / std::sqrt(size));
    }
  return m;
}

double second_difference(double angle) { return 2 - 2 * std::cos(angle); }

ImageMap map_of(ImageF& image) { return {image.data(), image.height(), image.width()}; }

ImageF solve_dirichlet(const ImageF& laplacian) {
  ImageF image = laplacian;
  const int w = image.width(), h = image.height();
  const Matrix along_x = sine_matrix(w), along_y = sine_matrix(h);
  ImageMap m = map_of(image);
  Matrix coefficients = along_y * m * along_x;
  for (int l = 0; l < h; ++l)
    for (int k = 0; k < w; ++k)
      coefficients(l, k) /=
          -static_cast<float>(second_difference(std::numbers::pi * (k + 1) / (w + 1)) +
                              second_difference(std::numbers::pi * (l + 1) / (h + 1)));
  m = along_y * coefficients * along_x;
  return image;
}

ImageF solve_neumann(const ImageF& laplacian) {
  ImageF image = laplacian;
  cosine_transform(image);
  for (int l = 0; l < image.height(); ++l)
    for (int k = 0; k < image.width(); ++k)
      image(k, l) = k + l == 0 ? 0
                               : image(k, l) / -static_cast<float>(neumann_eigenvalue(
                                                   k, l, image.width(), image.height()));
  inverse_cosine_transform(image);
  return image;
}

ImageF solve_wrapped(const ImageF& laplacian) {
  ImageF image = laplacian;
  const int w = image.width(), h = image.height();
  const Matrix along_x = hartley_matrix(w), along_y = cosine_matrix(h);
  ImageMap m = map_of(image);
  Matrix coefficients = along_y * m * along_x;
  for (int l = 0; l < h; ++l)
    for (int k = 0; k < w; ++k)
      coefficients(l, k) /=
          k + l == 0 ? -std::numeric_limits<float>::infinity()
                     : -static_cast<float>(second_difference(2 * std::numbers::pi * k / w) +
                                           second_difference(std::numbers::pi * l / h));
  m = along_y.transpose() * coefficients * along_x;
  return image;
}

/// OpenCV's transform takes even sizes only; others are small matrices.
void transform_cosine(ImageF& image, bool inverse) {
  if (image.width() % 2 == 0 && image.height() % 2 == 0) {
    const cv::Mat m(image.height(), image.width(), CV_32F, image.data());
    cv::Mat result;
    cv::dct(m, result, inverse ? cv::DCT_INVERSE : 0);
    result.copyTo(m);
    return;
  }
  const Matrix along_x = cosine_matrix(image.width()), along_y = cosine_matrix(image.height());
  ImageMap m = map_of(image);
  const Matrix result = inverse ? Matrix(along_y.transpose() * m * along_x)
                                : Matrix(along_y * m * along_x.transpose());
  m = result;
}

}  // namespace

GradientField forward_gradient(const ImageF& image) {
  GradientField g{ImageF(image.width(), image.height()), ImageF(image.width(), image.height())};
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      if (x + 1 < image.width()) g.x(x, y) = image(x + 1, y) - image(x, y);
      if (y + 1 < image.height()) g.y(x, y) = image(x, y + 1) - image(x, y);
    }
  return g;
}

ImageF divergence(const GradientField& gradient, bool wraps) {
  ImageF d(gradient.x.width(), gradient.x.height());
  const int last = d.width() - 1;
  for (int y = 0; y < d.height(); ++y) {
    const float across_seam = wraps ? gradient.x(last, y) : 0;
    for (int x = 0; x <= last; ++x)
      d(x, y) = (x < last ? gradient.x(x, y) : across_seam) -
                (x > 0 ? gradient.x(x - 1, y) : across_seam) +
                (y + 1 < d.height() ? gradient.y(x, y) : 0) - (y > 0 ? gradient.y(x, y - 1) : 0);
  }
  return d;
}

GradientField between_pixels(const ImageF& gx, const ImageF& gy, bool wraps) {
  GradientField g{gx, gy};
  const int last = gx.width() - 1;
  for (int y = 0; y < gx.height(); ++y) {
    for (int x = 0; x < last; ++x) g.x(x, y) = (gx(x, y) + gx(x + 1, y)) / 2;
    if (wraps) g.x(last, y) = (gx(last, y) + gx(0, y)) / 2;
  }
  for (int y = 0; y + 1 < gy.height(); ++y)
    for (int x = 0; x < gy.width(); ++x) g.y(x, y) = (gy(x, y) + gy(x, y + 1)) / 2;
  return g;
}

void subtract_mean(ImageF& image) {
  const double mean = std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0) /
                      static_cast<double>(image.size());
  for (float& value : image.pixels()) value -= static_cast<float>(mean);
}

ImageF solve_poisson(const ImageF& laplacian, Boundary boundary) {
  switch (boundary) {
    case Boundary::kDirichlet:
      return solve_dirichlet(laplacian);
    case Boundary::kNeumann:
      return solve_neumann(laplacian);
    case Boundary::kWrapped:
      return solve_wrapped(laplacian);
  }
  return {};
}

void cosine_transform(ImageF& image) { transform_cosine(image, false); }

void inverse_cosine_transform(ImageF& image) { transform_cosine(image, true); }

double neumann_eigenvalue(int k, int l, int width, int height) {
  return second_difference(std::numbers::pi * k / width) +
         second_difference(std::numbers::pi * l / height);
}

}  // namespace saccade
