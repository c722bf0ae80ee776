#pragma once

#include <string>
#include <vector>

#include "core/image.h"

namespace saccade {

/// A value of a chart with the range it was found in; `low` = `high` = `value` where there is none.
struct ChartValue {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// Maps values to positions along the axis of a chart, between round numbers. Logarithmic where all
/// values are above 0 and span more than a decade.
class Axis {
 public:
  /// `values`: what must be on the axis. `from_zero`: where it is linear it begins (or ends) at 0.
  Axis(const std::vector<double>& values, bool from_zero);

  [[nodiscard]] bool is_logarithmic() const { return is_logarithmic_; }
  /// 0 at the low end, 1 at the high end.
  [[nodiscard]] double share(double value) const;
  /// Round numbers from end to end.
  [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }

  /// "0.02", "20k", "1.5M".
  [[nodiscard]] static std::string text(double tick);

 private:
  void choose_linear(double low, double high);
  void choose_logarithmic(double low, double high);

  bool is_logarithmic_ = false;
  std::vector<double> ticks_;
};

/// Colours of the lines or bars of a chart, to be told apart on a light and on a dark ground; they
/// come again from the start when there are more.
[[nodiscard]] Rgb8 series_colour(std::size_t index);

}  // namespace saccade
