#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace saccade {

/// What a curve on the page goes through; x ascends.
struct CurvePoints {
  std::vector<double> x, y;

  void add(double at_x, double at_y) {
    x.push_back(at_x);
    y.push_back(at_y);
  }
};

/// Five significant digits, which are more than a screen shows; 0 for what is not finite.
[[nodiscard]] double five_digits(double value);

/// A time [s] to a tenth of a millisecond.
[[nodiscard]] double tenth_ms(double t_s);

/// `values` over `t_s`, at most `most` of them: the smallest and the largest value of every
/// stretch, so that no peak is lost. Rounded.
[[nodiscard]] CurvePoints thinned(std::span<const double> t_s, std::span<const double> values,
                                  std::size_t most);

/// Over x, the fraction [%] of the values that are at most x, at 0, 1, ..., 100 %. For an axis of
/// logarithms: what is not above 0 counts, but has no point.
[[nodiscard]] CurvePoints cumulative_percent(std::vector<double> values);

}  // namespace saccade
