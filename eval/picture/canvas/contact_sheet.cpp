#include "eval/picture/canvas/contact_sheet.h"

#include <algorithm>
#include <cstddef>
#include <sstream>

#include "eval/picture/canvas/canvas.h"

namespace saccade {
namespace {

constexpr int kSheetMargin = 16;
constexpr int kTitleHeight = 40;
constexpr int kLineHeight = 14;
constexpr int kBelowCaption = 8;
constexpr double kTitleText = 13;
constexpr double kCaptionText = 8;

/// A text in lines of at most `width` pixels; a word that is wider has a line for itself.
std::vector<std::string> wrapped(const std::string& text, int width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    const std::string longer = line.empty() ? word : line + " " + word;
    if (line.empty() || Canvas::text_width(longer, kCaptionText) <= width)
      line = longer;
    else
      lines.push_back(word);
  }
  return lines;
}

/// A row as it is drawn: the pictures' captions in lines.
struct Row {
  const std::vector<CaptionedPicture>& pictures;
  std::vector<std::vector<std::string>> captions;
  int caption_height = 0;
  int width = kSheetMargin, height = 0;  ///< with the captions and margins

  Row(const std::string& label, const std::vector<CaptionedPicture>& of) : pictures(of) {
    int picture_height = 0;
    std::size_t lines = 1;
    for (const CaptionedPicture& picture : pictures) {
      const std::string caption = label.empty() ? picture.caption : label + ": " + picture.caption;
      captions.push_back(wrapped(caption, picture.image.width()));
      lines = std::max(lines, captions.back().size());
      width += picture.image.width() + kSheetMargin;
      picture_height = std::max(picture_height, picture.image.height());
    }
    caption_height = static_cast<int>(lines) * kLineHeight + kBelowCaption;
    height = caption_height + picture_height + kSheetMargin;
  }
};

}  // namespace

void ContactSheet::add_row(std::string label, std::vector<CaptionedPicture> pictures) {
  rows_.emplace_back(std::move(label), std::move(pictures));
}

ImageRgb8 ContactSheet::draw() const {
  std::vector<Row> rows;
  int width = Canvas::text_width(title_, kTitleText) + 2 * kSheetMargin;
  int height = kTitleHeight;
  for (const auto& [label, pictures] : rows_) {
    const Row& row = rows.emplace_back(label, pictures);
    width = std::max(width, row.width);
    height += row.height;
  }
  Canvas canvas(width, height, theme_.background);
  canvas.text(title_, {kSheetMargin, 26}, theme_.text, kTitleText);
  const Rgb8 colour = mix(theme_.faint, theme_.text, 0.75);
  int y = kTitleHeight;
  for (const Row& row : rows) {
    int x = kSheetMargin;
    for (std::size_t i = 0; i < row.pictures.size(); ++i) {
      for (std::size_t line = 0; line < row.captions[i].size(); ++line)
        canvas.text(row.captions[i][line],
                    Eigen::Vector2d(x, y + kLineHeight * (static_cast<int>(line) + 1)), colour,
                    kCaptionText);
      canvas.paste(row.pictures[i].image, x, y + row.caption_height);
      x += row.pictures[i].image.width() + kSheetMargin;
    }
    y += row.height;
  }
  return canvas.image();
}

}  // namespace saccade
