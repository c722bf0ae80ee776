#pragma once

namespace saccade {

/// Belief about one point's inverse depth: Gaussian around the true value with inlier probability
/// beta(a, b) (Vogiatzis & Hernandez, Image and Vision Computing 29(7), 2011; thesis 5.14).
struct DepthBelief {
  double mean = 0;      ///< mu [1/m]
  double variance = 0;  ///< sigma^2 [1/m^2]
  double a = 10;        ///< inliers counted so far, with those of the prior
  double b = 10;        ///< outliers counted so far, with those of the prior

  [[nodiscard]] double inlier_probability() const { return a / (a + b); }
};

/// Update by a measurement x with variance tau^2, which is either an inlier, N(x; mu, s2 + tau^2),
/// or uniform over `range` [1/m]:
///   S2 = 1 / (1/s2 + 1/tau^2),  m = S2 (mu/s2 + x/tau^2),
///   C1 = a/(a+b) N(x; mu, s2 + tau^2),  C2 = b/(a+b) / range,  C1 + C2 = 1 after scaling,
///   f = C1 (a+1)/(a+b+1) + C2 a/(a+b+1),
///   e = C1 (a+1)(a+2)/((a+b+1)(a+b+2)) + C2 a(a+1)/((a+b+1)(a+b+2)),
///   mu' = C1 m + C2 mu,  s2' = C1 (S2 + m^2) + C2 (s2 + mu^2) - mu'^2,
///   a' = (e - f) / (f - e/f),  b' = a' (1 - f) / f:
/// the belief whose first two moments in depth and inlier probability are those of the exact
/// posterior. `variance` > 0, `range` > 0.
[[nodiscard]] DepthBelief updated(const DepthBelief& belief, double measurement, double variance,
                                  double range);

}  // namespace saccade
