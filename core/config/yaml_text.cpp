#include "core/config/yaml_text.h"

#include <algorithm>

namespace saccade::config {

std::optional<int> line_of_control_character(std::string_view text) {
  const auto is_control = [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return (u < 0x20 && c != '\n' && c != '\r' && c != '\t') || u == 0x7f;
  };
  const auto found = std::find_if(text.begin(), text.end(), is_control);
  if (found == text.end()) return std::nullopt;
  return 1 + static_cast<int>(std::count(text.begin(), found, '\n'));
}

bool is_closed_quote(std::string_view text, std::size_t position) {
  constexpr std::string_view kWhite = " \t\r\n";
  while (position < text.size() && (text[position] == '&' || text[position] == '!')) {
    position = std::min(text.find_first_of(kWhite, position), text.size());
    position = std::min(text.find_first_not_of(kWhite, position), text.size());
  }
  if (position >= text.size() || (text[position] != '"' && text[position] != '\'')) return true;
  const char quote = text[position];
  for (std::size_t i = position + 1; i < text.size(); ++i) {
    const bool doubled = quote == '\'' && i + 1 < text.size() && text[i + 1] == quote;
    if (text[i] == quote && !doubled) return true;
    if ((quote == '"' && text[i] == '\\') || (text[i] == quote && doubled)) ++i;
  }
  return false;
}

}  // namespace saccade::config
