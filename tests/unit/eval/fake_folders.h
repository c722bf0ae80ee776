#pragma once

#include "tests/support/fake_run.h"
#include "tests/support/shared_folder.h"

namespace saccade::testing {

/// A small dataset and a run over it.
class FakeFolders : public SharedFolder<FakeFolders> {
 public:
  static void fill() {
    write_corner_dataset(dataset(), "walls", 0.25, 80);
    write_fake_run(run(), dataset());
  }

 protected:
  [[nodiscard]] static std::filesystem::path dataset() { return path("data"); }
  [[nodiscard]] static std::filesystem::path run() { return path("walls_accurate"); }
};

}  // namespace saccade::testing
