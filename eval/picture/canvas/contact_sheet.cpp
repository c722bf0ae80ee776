#include "eval/picture/canvas/contact_sheet.h"

#include <algorithm>

#include "eval/picture/canvas/canvas.h"

namespace saccade {
namespace {

constexpr int kSheetMargin = 16;
constexpr int kTitleHeight = 40;
constexpr int kRowCaptionHeight = 22;
constexpr double kTitleText = 13;
constexpr double kCaptionText = 8;

}  // namespace

void ContactSheet::add_row(std::string label, std::vector<CaptionedPicture> pictures) {
  rows_.emplace_back(std::move(label), std::move(pictures));
}

ImageRgb8 ContactSheet::draw() const {
  int width = Canvas::text_width(title_, kTitleText) + 2 * kSheetMargin;
  int height = kTitleHeight;
  for (const auto& [label, pictures] : rows_) {
    int row_width = kSheetMargin;
    int row_height = 0;
    for (const CaptionedPicture& picture : pictures) {
      row_width += picture.image.width() + kSheetMargin;
      row_height = std::max(row_height, picture.image.height());
    }
    width = std::max(width, row_width);
    height += kRowCaptionHeight + row_height + kSheetMargin;
  }
  Canvas canvas(width, height, theme_.background);
  canvas.text(title_, {kSheetMargin, 26}, theme_.text, kTitleText);
  int y = kTitleHeight;
  for (const auto& [label, pictures] : rows_) {
    int x = kSheetMargin;
    int row_height = 0;
    for (const CaptionedPicture& picture : pictures) {
      const std::string caption = label.empty() ? picture.caption : label + "  " + picture.caption;
      canvas.text(caption, Eigen::Vector2d(x, y + 14), mix(theme_.faint, theme_.text, 0.75),
                  kCaptionText);
      canvas.paste(picture.image, x, y + kRowCaptionHeight);
      x += picture.image.width() + kSheetMargin;
      row_height = std::max(row_height, picture.image.height());
    }
    y += kRowCaptionHeight + row_height + kSheetMargin;
  }
  return canvas.image();
}

}  // namespace saccade
