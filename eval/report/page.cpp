#include "eval/report/page.h"

#include <fmt/format.h>

#include <span>
#include <string_view>

#include "core/io/files/sha256.h"
#include "core/version.h"
#include "eval/report/assets.h"
#include "eval/report/charts/page_data.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

constexpr std::size_t kHashDigits = 8;

std::string hashed_name(std::string_view text, const char* ending) {
  return fmt::format("report-{}.{}", sha256(std::as_bytes(std::span(text))).substr(0, kHashDigits),
                     ending);
}

std::string style_of(const Page& page) {
  if (page.assets.empty()) return fmt::format("<style>\n{}\n</style>", assets::report_css);
  return fmt::format("<link rel=\"stylesheet\" href=\"{}/{}\">", escape_html(page.assets),
                     hashed_name(assets::report_css, "css"));
}

std::string script_of(const Page& page) {
  if (page.assets.empty()) return fmt::format("<script>\n{}\n</script>", assets::report_js);
  return fmt::format("<script src=\"{}/{}\"></script>", escape_html(page.assets),
                     hashed_name(assets::report_js, "js"));
}

}  // namespace

std::string page_text(const Page& page) {
  return fill_page(assets::page_html,
                   {{"title", escape_html(page.title)},
                    {"summary", page.summary},
                    {"contents", page.contents},
                    {"style", style_of(page)},
                    {"body", page.body},
                    {"charts", charts_data(page.charts)},
                    {"script", script_of(page)},
                    {"footer", fmt::format("Written by saccade {} ({}). Definitions: {}.",
                                           version(), git_commit(), page.definitions)}});
}

std::vector<PageAsset> page_assets() {
  return {{hashed_name(assets::report_css, "css"), assets::report_css},
          {hashed_name(assets::report_js, "js"), assets::report_js}};
}

}  // namespace saccade
