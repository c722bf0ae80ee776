#include "estimator/rotation/rotation_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_folder.h"
#include "tests/support/source_path.h"
#include "tests/unit/estimator/imu/turning_dataset.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

class RotationModule : public testing::SharedFolder<RotationModule> {
 public:
  static void fill() { testing::write_turning_dataset(path("corner"), 0.25, 120); }

 protected:
  /// RMS error [rad/s].
  static double run(const std::string& name, const std::string& yaml) {
    run_rotation(testing::run_request(path("corner"), path(name), yaml));
    const auto rates = read_angular_velocities(path(name) / "angular_velocity.txt");
    EXPECT_GT(rates.size(), 2U);
    double squares = 0;
    for (const StampedTwist& rate : rates)
      squares += (rate.angular_velocity - testing::corner_rate(rate.t_s)).squaredNorm();
    return std::sqrt(squares / static_cast<double>(rates.size()));
  }
};

TEST_F(RotationModule, ThePerfectSensorIsRight) {
  EXPECT_LT(run("imu", "{method: imu, orientation: {method: gyroscope}}"), 1e-6);
}

TEST_F(RotationModule, AveragesTheReadings) {
  EXPECT_LT(run("average", "{method: imu, averaging_s: 0.01, orientation: {method: gyroscope}}"),
            0.05);
}

TEST_F(RotationModule, BothFollowTheSensorOverAWindow) {
  // The corner also moves, which events alone take for a turn: the bias follows it.
  EXPECT_LT(run("both", "{method: both, window: {events: 4000}}"), 2);
}

TEST_F(RotationModule, NamesWhatItDoesNotKnow) {
  EXPECT_THAT(
      error_of([] {
        return config::read<RotationConfig>(config::parse("window: {event: 200}", "t.yaml")).seed;
      }),
      ::testing::AllOf(HasSubstr("t.yaml:1"), HasSubstr("did you mean 'events'?")));
  EXPECT_THAT(error_of([] {
                return config::read<RotationConfig>(config::parse("method: eyes", "t.yaml")).seed;
              }),
              HasSubstr("t.yaml:1"));
}

TEST_F(RotationModule, WindowsOfTooFewEventsSayNothing) {
  const std::string yaml = "{window: {events: 100}}";
  run_rotation(testing::run_request(path("corner"), path("still"), yaml));
  EXPECT_TRUE(read_angular_velocities(path("still") / "angular_velocity.txt").empty());
}

TEST_F(RotationModule, WithoutASensorItSaysWhatIsMissing) {
  testing::write_corner_dataset(path("no_imu"), "corner", 0.05, 80);
  RunRequest request;
  request.dataset = path("no_imu");
  request.output = path("x");
  request.config = config::parse("method: both", "t.yaml");
  EXPECT_THAT(error_of([&] { return run_rotation(request).found; }), HasSubstr("holds no imu.txt"));
}

TEST(RotationConfig, ShippedFilesAreRead) {
  const std::string folder = testing::source_path("configs/rotation/");
  const auto method = [&](const char* name) {
    return config::read<RotationConfig>(config::load(folder + name)).method;
  };
  EXPECT_EQ(method("events.yaml"), RotationConfig::Method::kEvents);
  EXPECT_EQ(method("imu.yaml"), RotationConfig::Method::kImu);
  EXPECT_EQ(method("both.yaml"), RotationConfig::Method::kBoth);
}

}  // namespace
}  // namespace saccade
