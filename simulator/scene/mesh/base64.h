#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "simulator/scene/mesh/file_source.h"

namespace saccade {

/// RFC 4648, section 4, as data URIs have it. Decoding takes it with or without padding; nullopt
/// where a character is none of the alphabet.
[[nodiscard]] std::string base64_of(const Bytes& bytes);
[[nodiscard]] std::optional<Bytes> bytes_of_base64(std::string_view text);

}  // namespace saccade
