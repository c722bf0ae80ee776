#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace saccade {

/// An instance in the image of one instant: its pixels in the mask are within columns x0 .. x1 and
/// rows y0 .. y1, both ends included, and touch all four sides.
struct InstanceBox {
  double t_s = 0;
  std::uint16_t instance = 0;
  std::uint8_t class_id = 0;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< [px]
  /// Its pixels in the mask over those that it would have if nothing stood before it.
  double visible_fraction = 1;

  [[nodiscard]] bool operator==(const InstanceBox&) const = default;
};

/// Lines `t instance class x0 y0 x1 y1 visible_fraction` below a comment that names the columns:
/// seconds with 9 decimals, the fraction with 6.
void write_boxes(const std::filesystem::path& file, std::span<const InstanceBox> boxes);

/// In order of time, then of the instance. InputError with `file:line` for lines that are not, and
/// for numbers out of range.
[[nodiscard]] std::vector<InstanceBox> read_boxes(const std::filesystem::path& file);

}  // namespace saccade
