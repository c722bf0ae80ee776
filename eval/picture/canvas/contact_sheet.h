#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// The times that a contact sheet shows, as fractions of the duration.
inline constexpr double kSheetTimes[] = {0.08, 0.36, 0.64, 0.92};

struct CaptionedPicture {
  std::string caption;
  ImageRgb8 image;
};

/// Rows of captioned pictures below a title. The label of a row precedes its captions, which go on in
/// further lines where their picture is narrower.
class ContactSheet {
 public:
  ContactSheet(std::string title, const Theme& theme) : title_(std::move(title)), theme_(theme) {}

  void add_row(std::string label, std::vector<CaptionedPicture> pictures);
  [[nodiscard]] ImageRgb8 draw() const;

 private:
  std::string title_;
  Theme theme_;
  std::vector<std::pair<std::string, std::vector<CaptionedPicture>>> rows_;  ///< with labels
};

}  // namespace saccade
