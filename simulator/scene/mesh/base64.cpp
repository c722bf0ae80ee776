#include "simulator/scene/mesh/base64.h"

#include <array>
#include <cstdint>

namespace saccade {
namespace {

constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::uint8_t, 256> kBase64Codes = [] {
  std::array<std::uint8_t, 256> codes{};
  codes.fill(255);
  for (std::size_t i = 0; i < kBase64.size(); ++i)
    codes[static_cast<unsigned char>(kBase64[i])] = static_cast<std::uint8_t>(i);
  return codes;
}();

}  // namespace

std::string base64_of(const Bytes& bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kBase64[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::optional<Bytes> bytes_of_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t group = 0;
  unsigned bits = 0;
  for (const char c : text) {
    const std::uint8_t code = kBase64Codes[static_cast<unsigned char>(c)];
    if (code == 255) return std::nullopt;
    group = (group << 6U | code) & 0xFFFFFFU;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<unsigned char>(group >> bits & 0xFFU));
  }
  return bytes;
}

}  // namespace saccade
