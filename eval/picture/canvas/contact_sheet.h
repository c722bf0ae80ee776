#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// The moments that a sheet shows, as shares of the time.
inline constexpr double kSheetTimes[] = {0.08, 0.36, 0.64, 0.92};

struct CaptionedPicture {
  std::string caption;
  ImageRgb8 image;
};

/// Rows of captioned pictures below a title, each row with its label; what scenes look like at a
/// glance.
class ContactSheet {
 public:
  ContactSheet(std::string title, const Theme& theme) : title_(std::move(title)), theme_(theme) {}

  void add_row(std::string label, std::vector<CaptionedPicture> pictures);
  [[nodiscard]] ImageRgb8 draw() const;

 private:
  struct Row {
    std::string label;
    std::vector<CaptionedPicture> pictures;
  };

  std::string title_;
  Theme theme_;
  std::vector<Row> rows_;
};

}  // namespace saccade
