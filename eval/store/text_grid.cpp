#include "eval/store/text_grid.h"

#include <algorithm>

#include "core/check.h"

namespace saccade {
namespace {

/// Letters of UTF-8 text: bytes that continue none.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

TextGrid::TextGrid(std::vector<std::string> titles, std::size_t text_columns)
    : text_columns_(text_columns), rows_{std::move(titles)} {}

void TextGrid::add(std::vector<std::string> cells) {
  SACCADE_CHECK(cells.size() == rows_.front().size());
  rows_.push_back(std::move(cells));
}

std::string TextGrid::text() const {
  std::vector<std::size_t> widths(rows_.front().size());
  for (const std::vector<std::string>& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], letters(row[i]));
  std::string text;
  for (const std::vector<std::string>& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - letters(row[i]), ' ');
      line += i == 0 ? "" : "  ";
      line += i < text_columns_ ? row[i] + space : space + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace saccade
