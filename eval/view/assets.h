#pragma once

#include <string_view>

/// Files that are built into the library: the page of `saccade view` with its bundled style and
/// script (eval/view/web).
namespace saccade::assets {

extern const std::string_view view_page_html;
extern const std::string_view view_css;
extern const std::string_view view_js;

}  // namespace saccade::assets
