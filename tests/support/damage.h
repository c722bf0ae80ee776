#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace saccade::testing {

/// `decode(bytes)` of every file that ends before byte `end` of `file` must be an InputError; with
/// any one byte of the whole changed it may be that or a result, but nothing else.
template <class Decode>
void expect_damage_is_reported(const std::string& file, std::size_t end, const Decode& decode) {
  for (std::size_t size = 0; size < end; ++size)
    EXPECT_THROW(static_cast<void>(decode(file.substr(0, size))), InputError)
        << size << " of " << file.size() << " bytes";
  for (std::size_t at = 0; at < file.size(); ++at)
    for (const int flip : {0x01, 0x80, 0xFF}) {
      std::string damaged = file;
      damaged[at] = static_cast<char>(damaged[at] ^ flip);
      try {
        static_cast<void>(decode(damaged));
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()), "");
      }
    }
}

}  // namespace saccade::testing
