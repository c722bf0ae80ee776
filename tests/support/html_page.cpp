#include "tests/support/html_page.h"

#include <cstddef>
#include <string_view>

namespace saccade::testing {
namespace {

/// Whether the text at `position` stands in a tag <a ...>, a link that is followed by hand alone.
bool in_anchor(std::string_view html, std::size_t position) {
  const std::size_t tag = html.rfind('<', position);
  return tag != std::string_view::npos && html.substr(tag, 3) == "<a ";
}

}  // namespace

std::vector<std::string> external_references(const std::string& html) {
  std::vector<std::string> found;
  // No regular expression: std::regex recurses once per character of an embedded picture.
  for (const std::string_view start : {"src=\"", "href=\"", "srcset=\"", "url(", "@import "})
    for (std::size_t i = 0; (i = html.find(start, i)) != std::string::npos;) {
      i += start.size();
      const std::string_view value = std::string_view(html).substr(i, 80);
      if (value.starts_with("data:") || value.starts_with("#") || in_anchor(html, i)) continue;
      found.push_back(std::string(start) +
                      std::string(value.substr(0, value.find_first_of("\")> "))));
    }
  return found;
}

}  // namespace saccade::testing
