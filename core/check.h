#pragma once

namespace saccade::detail {

/// Prints the broken contract to stderr and aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace saccade::detail

/// A contract between functions of this program; active in every build type. Never for bad input
/// from outside: that is an InputError.
#define SACCADE_CHECK(condition)                                       \
  do {                                                                 \
    if (!(condition)) [[unlikely]]                                     \
      ::saccade::detail::check_failed(#condition, __FILE__, __LINE__); \
  } while (false)
