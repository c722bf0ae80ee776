#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace saccade::testing {

/// Path of a real recording that is too large for the repository, e.g. "slider_depth". Looked for
/// in the folder named by the environment variable SACCADE_SHARED_DATA, or else in ../shared/data
/// beside the checkout. Empty when it is not there.
[[nodiscard]] std::filesystem::path find_shared_data(const std::string& name);

}  // namespace saccade::testing

/// Defines `variable` as the path of the recording `name`, or skips the test with a message that
/// says where it was looked for.
#define SACCADE_SHARED_DATA_OR_SKIP(variable, name)                                  \
  const std::filesystem::path variable = ::saccade::testing::find_shared_data(name); \
  if (variable.empty())                                                              \
  GTEST_SKIP() << "recording " << (name) << " is in neither $SACCADE_SHARED_DATA nor ../shared/data"
