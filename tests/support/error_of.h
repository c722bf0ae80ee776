#pragma once

#include <string>
#include <utility>

#include "core/error.h"

namespace saccade::testing {

/// What InputError says; "no error" when nothing is thrown. Every other exception fails the test.
template <class Function>
std::string error_of(Function&& function) {
  try {
    static_cast<void>(std::forward<Function>(function)());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace saccade::testing
