#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/command.h"
#include "tests/support/fake_run.h"

namespace saccade::testing {

/// A small dataset and a run over it, written once for all tests of a suite and left as they are.
class FakeFolders : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    write_corner_dataset(dataset(), "walls", 0.25, 80);
    write_fake_run(run(), dataset());
  }
  static void TearDownTestSuite() { folder_.reset(); }

  [[nodiscard]] static std::filesystem::path dataset() { return folder_->path() / "data"; }
  [[nodiscard]] static std::filesystem::path run() { return folder_->path() / "walls_accurate"; }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

}  // namespace saccade::testing
