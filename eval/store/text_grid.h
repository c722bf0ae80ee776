#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace saccade {

/// A table for a terminal: columns as wide as their widest cell, text to the left, numbers to the
/// right.
class TextGrid {
 public:
  /// The first `text_columns` columns hold text.
  TextGrid(std::vector<std::string> titles, std::size_t text_columns);
  /// As many cells as titles (contract).
  void add(std::vector<std::string> cells);
  [[nodiscard]] std::string text() const;

 private:
  std::size_t text_columns_;
  std::vector<std::vector<std::string>> rows_;  ///< the titles first
};

}  // namespace saccade
