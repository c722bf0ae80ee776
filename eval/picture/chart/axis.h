#pragma once

#include <string>
#include <vector>

#include "core/image.h"

namespace saccade {

/// A value of a chart with its range; `low` = `high` = `value` where there is none.
struct ChartValue {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// The axis of a chart: maps values to positions, and has its ticks at round numbers. Logarithmic
/// where all values are above 0 and span more than a decade.
class Axis {
 public:
  /// The axis covers `values`. `from_zero`: a linear axis includes 0.
  Axis(const std::vector<double>& values, bool from_zero);

  [[nodiscard]] bool is_logarithmic() const { return is_logarithmic_; }
  /// The position of a value: 0 at the low end, 1 at the high end.
  [[nodiscard]] double position(double value) const;
  /// Round numbers, from the low to the high end.
  [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }

  /// "0.02", "20k", "1.5M".
  [[nodiscard]] static std::string text(double tick);

 private:
  void choose_linear(double low, double high);
  void choose_logarithmic(double low, double high);

  bool is_logarithmic_ = false;
  std::vector<double> ticks_;
};

/// Colours of the lines or bars of a chart, which differ on a light and on a dark background. They
/// repeat after the eighth.
[[nodiscard]] Rgb8 series_colour(std::size_t index);

}  // namespace saccade
