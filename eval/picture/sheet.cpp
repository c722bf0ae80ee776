#include "eval/picture/sheet.h"

#include <algorithm>

#include "eval/picture/canvas.h"

namespace saccade {
namespace {

constexpr int kMargin = 16;
constexpr int kTitleHeight = 40;
constexpr int kCaptionHeight = 22;
constexpr double kTitleText = 13;
constexpr double kCaptionText = 8;

}  // namespace

void Sheet::add_row(std::string label, std::vector<CaptionedPicture> pictures) {
  rows_.push_back({std::move(label), std::move(pictures)});
}

ImageRgb8 Sheet::draw() const {
  int width = Canvas::text_width(title_, kTitleText) + 2 * kMargin;
  int height = kTitleHeight;
  for (const Row& row : rows_) {
    int row_width = kMargin;
    int row_height = 0;
    for (const CaptionedPicture& picture : row.pictures) {
      row_width += picture.image.width() + kMargin;
      row_height = std::max(row_height, picture.image.height());
    }
    width = std::max(width, row_width);
    height += kCaptionHeight + row_height + kMargin;
  }
  Canvas canvas(width, height, theme_.background);
  canvas.text(title_, {kMargin, 26}, theme_.text, kTitleText);
  int y = kTitleHeight;
  for (const Row& row : rows_) {
    int x = kMargin;
    int row_height = 0;
    for (const CaptionedPicture& picture : row.pictures) {
      const std::string caption =
          row.label.empty() ? picture.caption : row.label + "  " + picture.caption;
      canvas.text(caption, Eigen::Vector2d(x, y + 14), mix(theme_.faint, theme_.text, 0.75),
                  kCaptionText);
      canvas.paste(picture.image, x, y + kCaptionHeight);
      x += picture.image.width() + kMargin;
      row_height = std::max(row_height, picture.image.height());
    }
    y += kCaptionHeight + row_height + kMargin;
  }
  return canvas.image();
}

}  // namespace saccade
