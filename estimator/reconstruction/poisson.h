#pragma once

#include "core/image.h"

namespace saccade {

/// What is assumed beyond the image's border.
enum class Boundary {
  kDirichlet,  ///< the image is 0 around it (thesis 6.20)
  kNeumann,    ///< the gradient across it is 0
  kWrapped     ///< likewise above and below; the first column follows the last one
};

/// A gradient per pixel; `x`(u, v) belongs between (u, v) and (u + 1, v), `y`(u, v) between (u, v)
/// and (u, v + 1) [1/px].
struct GradientField {
  ImageF x;
  ImageF y;
};

/// Forward differences, 0 in the last column of x and the last row of y.
[[nodiscard]] GradientField forward_gradient(const ImageF& image);

/// div g by backward differences: with forward_gradient() the 5-point Laplacian (6.17, 6.18). At
/// the border g is 0 beyond the image, or goes on across the seam of one that wraps.
[[nodiscard]] ImageF divergence(const GradientField& gradient, bool wraps = false);

/// From the pixels' centres to the midpoints between neighbours, where the Laplacian wants them.
[[nodiscard]] GradientField between_pixels(const ImageF& gx, const ImageF& gy, bool wraps = false);

/// Solves lap I = f (6.19) on the pixel grid, exactly up to rounding: by a sine transform
/// (Dirichlet) or a cosine transform (Neumann; the constant is fixed by mean 0, and of f only what
/// has mean 0 counts), along wrapped rows by a Hartley transform.
[[nodiscard]] ImageF solve_poisson(const ImageF& laplacian, Boundary boundary);

void subtract_mean(ImageF& image);

/// Cosine transform (DCT-II, orthonormal) of any size and its inverse; the eigenvalues of the
/// Laplacian with Neumann boundary are -(2 - 2 cos(pi k / w)) - (2 - 2 cos(pi l / h)).
class CosineTransform {
 public:
  CosineTransform(int width, int height);
  /// In place; `image` has the size of the transform.
  void forward(ImageF& image) const;
  void inverse(ImageF& image) const;
  /// -eigenvalue >= 0 of the Laplacian for coefficient (k, l) [1/px^2].
  [[nodiscard]] double eigenvalue(int k, int l) const;

 private:
  int width_, height_;
};

}  // namespace saccade
