#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/command.h"

namespace saccade::testing {

/// A temporary folder that the tests of a suite share: `Suite::fill()` writes into it once, and the
/// tests leave that as it is.
template <class Suite>
class SharedFolder : public ::testing::Test {
 public:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    Suite::fill();
  }
  static void TearDownTestSuite() { folder_.reset(); }

 protected:
  [[nodiscard]] static std::filesystem::path path(const std::string& name) {
    return folder_->path() / name;
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

}  // namespace saccade::testing
