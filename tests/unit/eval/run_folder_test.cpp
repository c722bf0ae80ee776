#include "eval/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;

class RunFreedom : public testing::FakeFolders {
 protected:
  RunFreedom() { std::filesystem::copy(run(), folder()); }
  [[nodiscard]] std::filesystem::path folder() const { return temporary_.path() / "run"; }
  [[nodiscard]] Alignment freedom() const { return RunFolder::open(folder()).freedom(); }

  testing::TemporaryFolder temporary_;
};

TEST_F(RunFreedom, IsOfAStartWithoutPosesAndLessWithAnInertialSensorThatAgrees) {
  EXPECT_EQ(freedom(), Alignment::kNone);
  temporary_.write("run/inertial.yaml", "applied: true\n");
  EXPECT_EQ(freedom(), Alignment::kNone) << "its start was given";
  temporary_.write("run/start.yaml", "");
  EXPECT_EQ(freedom(), Alignment::kYaw);
  temporary_.write("run/inertial.yaml", "status: no_readings\napplied: false\n");
  EXPECT_EQ(freedom(), Alignment::kSim3);
  std::filesystem::remove(folder() / "inertial.yaml");
  EXPECT_EQ(freedom(), Alignment::kSim3);
}

TEST_F(RunFreedom, AnInertialRecordThatSaysNothingOfUseIsAnError) {
  temporary_.write("run/start.yaml", "");
  temporary_.write("run/inertial.yaml", "status: ok\napplied: perhaps\n");
  EXPECT_THAT(testing::error_of([&] { return freedom(); }), HasSubstr("inertial.yaml:2"));
}

}  // namespace
}  // namespace saccade
