// A sensor that one command finds and the others read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/run/run_record.h"
#include "core/io/sensor_file.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// 0.2 s of a small Walls with noise.
std::string record_walls(const TemporaryFolder& folder) {
  const std::string data = (folder.path() / "walls").string();
  saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o", data, "--set",
              "duration_s=0.2", "--set",
              "camera={width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}", "--set",
              "events.noise.refractory.period_us=800"});
  return data;
}

TEST(Calibrate, WritesASensorThatTheOthersRead) {
  const TemporaryFolder folder;
  const std::string data = record_walls(folder);
  const std::string sensor = (folder.path() / "sensor.yaml").string();
  EXPECT_THAT(saccade_ok({"calibrate", data, "-o", sensor, "--events-only"}),
              HasSubstr("refractory.period_us"));
  EXPECT_TRUE(fs::exists(folder.path() / "sensor.html"));
  SensorFile found = read_sensor_file(sensor);
  EXPECT_EQ(found.name, "sensor");
  EXPECT_FALSE(found.events.contrast_on) << "no simulation, no thresholds";
  EXPECT_TRUE(found.events.refractory_us);
  // As a person completes it.
  found.events.contrast_on = found.events.contrast_off = 0.21;
  write_sensor_file(sensor, found);
  // What a configuration states itself wins, and Walls states its thresholds.
  const std::string bare =
      folder
          .write("bare.yaml", "include: " + source_path("scenes/walls/scene.yaml") +
                                  "\ntrajectory: {source: circle}\n")
          .string();
  EXPECT_THAT(saccade_ok({"simulate", bare, "--sensor", sensor, "--print-config"}),
              AllOf(HasSubstr("contrast_on: 0.21"), HasSubstr("sensor.yaml")));
  const std::string run = (folder.path() / "run").string();
  saccade_ok({"run", "track", "--data", data, "-c", shipped_config("tracking/best.yaml"),
              "--sensor", sensor, "-o", run, "--set", "reference.new_view_deg=~"});
  EXPECT_THAT(read_run_record(run + "/run.yaml").config_yaml, HasSubstr("contrast_on: 0.21"));
}

TEST(Calibrate, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const CommandResult missing =
      saccade({"calibrate", "nowhere", "-o", (folder.path() / "sensor.yaml").string()});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.output, HasSubstr("nowhere"));
  const CommandResult nameless = saccade({"calibrate", "nowhere"});
  EXPECT_EQ(nameless.exit_code, 2);
  EXPECT_THAT(nameless.output, HasSubstr("-o"));
  const CommandResult sensor = saccade({"simulate", shipped_config("simulation/walls.yaml"),
                                        "--sensor", "nowhere.yaml", "--print-config"});
  EXPECT_EQ(sensor.exit_code, 2);
  EXPECT_THAT(sensor.output, HasSubstr("nowhere.yaml"));
}

}  // namespace
}  // namespace saccade::testing
