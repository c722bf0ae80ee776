#pragma once

#include <string_view>

/// The files of eval/report/assets, built into the library.
namespace saccade::assets {

extern const std::string_view page_html;
extern const std::string_view style_css;
extern const std::string_view script_js;

}  // namespace saccade::assets
