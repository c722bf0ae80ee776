#include "eval/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/check.h"
#include "core/io/files/compression.h"
#include "core/io/images/image_file.h"
#include "core/io/images/webp_file.h"
#include "eval/picture/canvas/canvas.h"

namespace saccade {
std::string escape_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string inside_script(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos; at += 6)
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string figure(const ImageRgb8& picture, std::string_view caption, std::string_view alt) {
  const bool is_webp = std::max(picture.width(), picture.height()) <= kMostWebpSide;
  return fmt::format(
      "<figure><img loading=\"lazy\" src=\"data:image/{};base64,{}\" width=\"{}\" height=\"{}\" "
      "alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
      is_webp ? "webp" : "png", base64(is_webp ? encode_webp(picture) : encode_png(picture)),
      picture.width(), picture.height(), escape_html(alt), caption);
}

std::string packed_html(std::string_view html) {
  const std::vector<std::byte> packed = pack_zlib(std::as_bytes(std::span(html)));
  const std::string_view bytes(reinterpret_cast<const char*>(packed.data()), packed.size());
  return "<script type=\"text/plain\" class=\"packed\">" + base64(bytes) + "</script>\n";
}

std::string repeat_html(const std::vector<std::string>& commands) {
  std::string lines;
  for (const std::string& command : commands)
    if (!command.empty()) lines += escape_html(command) + "\n";
  if (lines.empty()) return "";
  return "<details class=\"repeat\"><summary>Repeat</summary><pre>" + lines + "</pre></details>\n";
}

std::string upscaled_figure(const ImageRgb8& picture, std::string_view caption,
                            std::string_view alt) {
  return figure(upscale(picture, kUpscale), caption, alt);
}

std::string fill_page(std::string_view page, const std::map<std::string, std::string>& values) {
  std::string result;
  for (;;) {
    const std::size_t open = page.find("{{");
    result += page.substr(0, open);
    if (open == std::string_view::npos) return result;
    const std::size_t close = page.find("}}", open);
    SACCADE_CHECK(close != std::string_view::npos);
    const auto value = values.find(std::string(page.substr(open + 2, close - open - 2)));
    SACCADE_CHECK(value != values.end());
    result += value->second;
    page.remove_prefix(close + 2);
  }
}

}  // namespace saccade
