#pragma once

#include "core/image.h"

namespace saccade {

/// What is assumed beyond the image's border.
enum class Boundary {
  kDirichlet,  ///< the image is 0 around it (thesis 6.20)
  kNeumann,    ///< the gradient across it is 0
  kWrapped     ///< the same above and below; the first column follows the last one
};

/// A gradient per pixel; `x`(u, v) belongs between (u, v) and (u + 1, v), `y`(u, v) between (u, v)
/// and (u, v + 1) [1/px].
struct GradientField {
  ImageF x;
  ImageF y;
};

/// Forward differences, 0 in the last column of x and the last row of y.
[[nodiscard]] GradientField forward_gradient(const ImageF& image);

/// div g by backward differences: with forward_gradient() the 5-point Laplacian (6.17), (6.18). Beyond
/// the border g is 0, or continues across the seam of an image that wraps.
[[nodiscard]] ImageF divergence(const GradientField& gradient, bool wraps = false);

/// Interpolates from the pixels' centres to the midpoints between neighbours, as divergence() takes
/// them.
[[nodiscard]] GradientField between_pixels(const ImageF& gx, const ImageF& gy, bool wraps = false);

/// Solves lap I = f (6.19) on the pixel grid, exactly up to rounding: by a sine transform
/// (Dirichlet) or a cosine transform (Neumann; the constant is fixed by mean 0, and of f only what
/// has mean 0 counts), along wrapped rows by a Hartley transform.
[[nodiscard]] ImageF solve_poisson(const ImageF& laplacian, Boundary boundary);

void subtract_mean(ImageF& image);

/// Cosine transform (DCT-II, orthonormal) in place, of any size, and its inverse.
void cosine_transform(ImageF& image);
void inverse_cosine_transform(ImageF& image);
/// -eigenvalue >= 0 [1/px^2] of the Laplacian with Neumann boundary for coefficient (k, l):
/// (2 - 2 cos(pi k / w)) + (2 - 2 cos(pi l / h)).
[[nodiscard]] double neumann_eigenvalue(int k, int l, int width, int height);

}  // namespace saccade
